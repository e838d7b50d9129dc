#include "record/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bodeflow::record {
namespace {

using nlohmann::ordered_json;

class Writer {
 public:
  explicit Writer(bool pretty) : pretty_(pretty) {}

  void value(const ordered_json& json, int depth) {
    if (json.is_object()) {
      object(json, depth);
    } else if (json.is_array()) {
      array(json, depth);
    } else if (json.is_number_float()) {
      number(json.get<double>());
    } else {
      text_ += json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    }
  }

  std::string take() { return std::move(text_); }

 private:
  void object(const ordered_json& json, int depth) {
    text_ += '{';
    bool first = true;
    for (const auto& [key, member] : json.items()) {
      if (!first) text_ += pretty_ ? "," : ", ";
      first = false;
      line(depth + 1);
      value(ordered_json(key), 0);
      text_ += ": ";
      value(member, depth + 1);
    }
    if (!json.empty()) line(depth);
    text_ += '}';
  }

  void array(const ordered_json& json, int depth) {
    const bool lines = pretty_ && std::any_of(json.begin(), json.end(), [](const auto& entry) { return entry.is_object(); });
    text_ += '[';
    bool first = true;
    for (const auto& entry : json) {
      if (!first) text_ += lines ? "," : ", ";
      first = false;
      if (lines) line(depth + 1);
      value(entry, depth + 1);
    }
    if (lines) line(depth);
    text_ += ']';
  }

  void number(double x) {
    if (!std::isfinite(x)) {
      text_ += "null";
      return;
    }
    const std::size_t start = text_.size();
    fmt::format_to(std::back_inserter(text_), "{}", x);
    if (text_.find_first_of(".e", start) == std::string::npos) text_ += ".0";
  }

  void line(int depth) {
    if (!pretty_) return;
    text_ += '\n';
    text_.append(static_cast<std::size_t>(depth) * 2, ' ');
  }

  bool pretty_;
  std::string text_;
};

}  // namespace

std::string json_text(const ordered_json& json) {
  Writer writer(true);
  writer.value(json, 0);
  return writer.take() + '\n';
}

std::string json_line(const ordered_json& json) {
  Writer writer(false);
  writer.value(json, 0);
  return writer.take();
}

}  // namespace bodeflow::record
