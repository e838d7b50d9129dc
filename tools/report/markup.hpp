#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace bodeflow::tools::report {

/// The text as content or attribute value of HTML and SVG: markup characters as entities; what XML forbids, invalid UTF-8 and
/// marks that turn the direction of writing (names in files may be hostile) as U+FFFD.
std::string escaped(std::string_view text);

/// A short ASCII word for file names and anchors: letters, digits, '.', '_' and '-'; never empty, never "." or "..".
std::string slug(std::string_view text);

/// The first `most` characters of a UTF-8 text, the last one as an ellipsis where something was left out.
std::string shortened(std::string_view text, std::size_t most);

/// Characters (not bytes) of a UTF-8 text.
std::size_t length_of(std::string_view text);

struct Attribute {
  std::string_view name;
  std::string value;

  Attribute(std::string_view n, std::string v) : name(n), value(std::move(v)) {}
  Attribute(std::string_view n, const char* v) : name(n), value(v) {}
  Attribute(std::string_view n, double v);  ///< a coordinate of a drawing
};

/// HTML or SVG as it grows. Texts and attribute values are escaped here and nowhere else.
class Markup {
 public:
  Markup& open(std::string_view name, std::initializer_list<Attribute> attributes = {});
  Markup& close(std::string_view name);
  Markup& text(std::string_view text);
  /// An element that holds a text.
  Markup& element(std::string_view name, std::initializer_list<Attribute> attributes, std::string_view text);
  Markup& element(std::string_view name, std::string_view text) { return element(name, {}, text); }
  /// An element without content, closed in itself.
  Markup& single(std::string_view name, std::initializer_list<Attribute> attributes = {});
  Markup& add(const Markup& other);
  /// Text that is markup already (our own styles).
  Markup& trusted(std::string_view markup);

  const std::string& str() const { return text_; }
  bool empty() const { return text_.empty(); }

 private:
  void start(std::string_view name, std::initializer_list<Attribute> attributes);

  std::string text_;
};

}  // namespace bodeflow::tools::report
