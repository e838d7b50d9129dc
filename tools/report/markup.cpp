#include "report/markup.hpp"

#include <cstdint>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};

/// The UTF-8 character at the beginning of a text that is not empty.
Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80U) return {lead, 1, true};
  const std::size_t bytes = lead >= 0xF0U && lead < 0xF5U   ? 4
                            : lead >= 0xE0U && lead < 0xF0U ? 3
                            : lead >= 0xC2U && lead < 0xE0U ? 2
                                                            : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xC0U) != 0x80U) return {};
    code = (code << 6U) | (next & 0x3FU);
  }
  const bool too_long = (bytes == 3 && code < 0x800U) || (bytes == 4 && code < 0x10000U);
  const bool surrogate = code >= 0xD800U && code < 0xE000U;
  if (too_long || surrogate || code > 0x10FFFFU) return {};
  return {code, bytes, true};
}

bool is_allowed(std::uint32_t code) {
  if (code < 0x20U) return code == '\n' || code == '\t';
  const bool control = code >= 0x7FU && code < 0xA0U;
  const bool direction = (code >= 0x202AU && code <= 0x202EU) || (code >= 0x2066U && code <= 0x2069U);
  return !control && !direction && (code & 0xFFFEU) != 0xFFFEU;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    if (!character.valid || !is_allowed(character.code)) {
      out += kReplacement;
    } else if (character.code == '&') {
      out += "&amp;";
    } else if (character.code == '<') {
      out += "&lt;";
    } else if (character.code == '>') {
      out += "&gt;";
    } else if (character.code == '"') {
      out += "&quot;";
    } else if (character.code == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(0, character.bytes);
    }
    text.remove_prefix(character.valid ? character.bytes : 1);
  }
  return out;
}

std::string slug(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 80)) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    if (plain)
      out += c;
    else if (out.empty() || out.back() != '-')
      out += '-';
  }
  while (!out.empty() && (out.front() == '.' || out.front() == '-')) out.erase(out.begin());
  return out.empty() ? "unnamed" : out;
}

std::size_t length_of(std::string_view text) {
  std::size_t length = 0;
  for (; !text.empty(); ++length) text.remove_prefix(first_character(text).bytes);
  return length;
}

std::string shortened(std::string_view text, std::size_t most) {
  std::string_view rest = text;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < most; ++i) {
    if (rest.empty()) return std::string(text);
    if (i + 1 == most) break;
    const std::size_t bytes = first_character(rest).bytes;
    rest.remove_prefix(bytes);
    kept += bytes;
  }
  if (!rest.empty() && first_character(rest).bytes == rest.size()) return std::string(text);
  return std::string(text.substr(0, kept)) + "…";
}

Attribute::Attribute(std::string_view n, double v) : name(n), value(coordinate(v)) {}

void Markup::start(std::string_view name, std::initializer_list<Attribute> attributes) {
  text_ += '<';
  text_ += name;
  for (const auto& attribute : attributes) {
    text_ += ' ';
    text_ += attribute.name;
    text_ += "=\"";
    text_ += escaped(attribute.value);
    text_ += '"';
  }
}

Markup& Markup::open(std::string_view name, std::initializer_list<Attribute> attributes) {
  start(name, attributes);
  text_ += '>';
  return *this;
}

Markup& Markup::close(std::string_view name) {
  text_ += "</";
  text_ += name;
  text_ += ">";
  return *this;
}

Markup& Markup::text(std::string_view text) {
  text_ += escaped(text);
  return *this;
}

Markup& Markup::element(std::string_view name, std::initializer_list<Attribute> attributes, std::string_view content) {
  return open(name, attributes).text(content).close(name);
}

Markup& Markup::single(std::string_view name, std::initializer_list<Attribute> attributes) {
  start(name, attributes);
  text_ += "/>";
  return *this;
}

Markup& Markup::add(const Markup& other) { return trusted(other.text_); }

Markup& Markup::trusted(std::string_view markup) {
  text_ += markup;
  return *this;
}

}  // namespace bodeflow::tools::report
