#include "common/json.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace battery {

class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : text_(text) {}

  Json all() {
    Json value = next(0);
    skip();
    if (at_ != text_.size()) fail();
    return value;
  }

 private:
  static constexpr int kDeepest = 100;

  [[noreturn]] void fail() const { throw std::runtime_error("no JSON at byte " + std::to_string(at_)); }
  void skip() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void need(char c) {
    if (!take(c)) fail();
  }
  bool word(std::string_view w) {
    if (text_.substr(at_, w.size()) != w) return false;
    at_ += w.size();
    return true;
  }

  Json next(int depth) {
    if (depth > kDeepest) fail();
    Json v;
    skip();
    if (at_ == text_.size()) fail();
    if (text_[at_] == '"') {
      v.type_ = Json::Type::text;
      v.text_ = quoted();
    } else if (take('[')) {
      v.type_ = Json::Type::list;
      if (take(']')) return v;
      do v.list_.push_back(next(depth + 1));
      while (take(','));
      need(']');
    } else if (take('{')) {
      v.type_ = Json::Type::object;
      if (take('}')) return v;
      do {
        skip();
        const std::string name = quoted();
        need(':');
        v.object_[name] = next(depth + 1);
      } while (take(','));
      need('}');
    } else if (word("true") || word("false")) {
      v.type_ = Json::Type::boolean;
      v.number_ = text_[at_ - 2] == 'u' ? 1.0 : 0.0;
    } else if (!word("null")) {
      v.type_ = Json::Type::number;
      v.number_ = number();
    }
    return v;
  }

  double number() {
    const std::size_t end = text_.find_first_not_of("+-0123456789.eE", at_);
    const std::string digits(text_.substr(at_, end == std::string_view::npos ? text_.size() - at_ : end - at_));
    char* rest = nullptr;
    const double value = std::strtod(digits.c_str(), &rest);
    if (digits.empty() || *rest != '\0') fail();
    at_ += digits.size();
    return value;
  }

  unsigned hex4() {
    if (at_ + 4 > text_.size()) fail();
    unsigned code = 0;
    for (int n = 0; n < 4; ++n) {
      const auto digit = std::string_view("0123456789abcdef").find(static_cast<char>(text_[at_] | 0x20));
      if (digit == std::string_view::npos) fail();
      code = code * 16 + static_cast<unsigned>(digit);
      ++at_;
    }
    return code;
  }

  static void add_utf8(std::string& text, unsigned code) {
    const auto put = [&](unsigned byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
    if (code < 0x80) return put(code);
    if (code < 0x800) return put(0xC0 | code >> 6), put(0x80 | (code & 63));
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 63));
    put(0x80 | (code & 63));
  }

  std::string quoted() {
    std::string text;
    if (at_ == text_.size() || text_[at_] != '"') fail();
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] != '\\') {
        text += text_[at_];
        continue;
      }
      if (++at_ == text_.size()) fail();
      const auto escape = std::string_view("\"\\/bfnrt").find(text_[at_]);
      if (escape != std::string_view::npos) {
        text += "\"\\/\b\f\n\r\t"[escape];
      } else if (text_[at_] == 'u') {
        ++at_;
        add_utf8(text, hex4());
        --at_;
      } else {
        fail();
      }
    }
    if (at_ == text_.size()) fail();
    ++at_;
    return text;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

Json Json::parse(std::string_view text) { return JsonReader(text).all(); }

double Json::number() const { return type_ == Type::number || type_ == Type::boolean ? number_ : std::nan(""); }

const Json& Json::operator[](const std::string& name) const {
  static const Json nothing;
  const auto found = object_.find(name);
  return found == object_.end() ? nothing : found->second;
}

std::vector<std::string> Json::texts() const {
  std::vector<std::string> all;
  for (const Json& v : list_) all.push_back(v.text_);
  return all;
}

std::vector<double> Json::numbers() const {
  std::vector<double> all;
  for (const Json& v : list_) all.push_back(v.number());
  return all;
}

}  // namespace battery
