#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace battery {

/// A value of a JSON text. What is absent reads as null; null reads as NaN, "" and an empty list.
class Json {
 public:
  enum class Type { null, boolean, number, text, list, object };

  /// Throws std::runtime_error with the byte at which a text is no JSON.
  static Json parse(std::string_view text);

  Type type() const { return type_; }
  bool is_null() const { return type_ == Type::null; }
  bool truth() const { return type_ == Type::boolean && number_ != 0.0; }
  double number() const;
  const std::string& text() const { return text_; }
  const std::vector<Json>& list() const { return list_; }
  const std::map<std::string, Json>& object() const { return object_; }
  const Json& operator[](const std::string& name) const;
  std::vector<std::string> texts() const;
  std::vector<double> numbers() const;

 private:
  friend class JsonReader;
  Type type_ = Type::null;
  double number_ = 0.0;
  std::string text_;
  std::vector<Json> list_;
  std::map<std::string, Json> object_;
};

}  // namespace battery
