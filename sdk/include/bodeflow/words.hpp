#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Names: their form, and the one that was meant.
namespace bodeflow::detail {

/// True for a lower-case letter followed by lower-case letters, digits and _.
inline bool is_word(std::string_view text) {
  if (text.empty() || text[0] < 'a' || text[0] > 'z') return false;
  for (const char c : text) {
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')) return false;
  }
  return true;
}

/// True for words with dots between them: "family.name", "lines.first".
inline bool is_dotted(std::string_view text, std::size_t fewest, std::size_t most) {
  std::size_t words = 0;
  while (true) {
    const std::size_t dot = text.find('.');
    if (!is_word(text.substr(0, dot))) return false;
    ++words;
    if (dot == std::string_view::npos) return words >= fewest && words <= most;
    text.remove_prefix(dot + 1);
  }
}

/// How many letters must be put in, left out or replaced to make `b` of `a`.
inline std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// " (did you mean 'x'?)" for the name nearest to `found`, or "" where none is near. "gain" is near to "family.gain".
inline std::string meant(std::string_view found, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 100;
  if (found.empty() || found.size() > kLongest) return {};
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, found.size() / 3) + 1;
  for (const std::string& name : names) {
    if (name.size() > kLongest) continue;
    std::size_t d = edits(found, name);
    const std::size_t dot = name.rfind('.');
    if (dot != std::string::npos && found.find('.') == std::string_view::npos) {
      d = std::min(d, edits(found, std::string_view(name).substr(dot + 1)) + 1);
    }
    if (d < least && d < found.size()) {
      least = d;
      nearest = &name;
    }
  }
  return nearest == nullptr ? std::string() : " (did you mean '" + *nearest + "'?)";
}

/// "a, b, c"; "none" for an empty list.
inline std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace bodeflow::detail
