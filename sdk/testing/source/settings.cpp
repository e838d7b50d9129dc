#include <bodeflow/testing/settings.hpp>
#include <fstream>
#include <sstream>

namespace bodeflow::testing {
namespace {

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// The parts of a line at `separator` outside of brackets and quotes; '#' outside of quotes ends it.
Expected<std::vector<std::string>, Error> split(std::string_view line, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted && c == '#') break;
    if (!quoted && c == '[') ++depth;
    if (!quoted && c == ']' && --depth < 0) return unexpected("']' without '['");
    if (!quoted && depth == 0 && c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (quoted) return unexpected("'\"' is not closed");
  if (depth != 0) return unexpected("'[' is not closed");
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

Expected<void, Error> read_line(std::string_view line, Settings& settings) {
  auto whole = split(line, '\n');
  if (!whole) return Unexpected<Error>{whole.error()};
  const std::string text = whole->front();
  if (text.empty()) return {};
  const auto colon = text.find(':');
  if (colon == std::string::npos) return unexpected("no ':' behind the block's id");
  const std::string id = trimmed(std::string_view(text).substr(0, colon));
  auto parts = split(std::string_view(text).substr(colon + 1), ',');
  if (!parts) return Unexpected<Error>{parts.error()};
  Setting setting;
  for (const std::string& part : *parts) {
    if (part.empty()) continue;
    const auto equals = part.find('=');
    if (equals == std::string::npos) return unexpected("'" + part + "' has not the form name = value");
    setting.emplace_back(trimmed(std::string_view(part).substr(0, equals)), trimmed(std::string_view(part).substr(equals + 1)));
  }
  settings[id].push_back(std::move(setting));
  return {};
}

}  // namespace

Expected<Settings, Error> parse_settings(std::string_view text) {
  Settings settings;
  int number = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    if (auto read = read_line(line, settings); !read) return unexpected(std::to_string(number) + ": " + read.error().text);
  }
  return settings;
}

Expected<Settings, Error> read_settings(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return unexpected(file + ": can't be read");
  std::ostringstream text;
  text << stream.rdbuf();
  auto settings = parse_settings(text.str());
  if (!settings) return unexpected(file + ":" + settings.error().text);
  return settings;
}

}  // namespace bodeflow::testing
