#include "yaml_reader.hpp"

#include <bodeflow/units.hpp>
#include <bodeflow/words.hpp>
#include <cstdlib>

#include "records/signals.hpp"

namespace bodeflow::drive::modbus {
namespace {

const char* kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  return node.IsScalar() ? "a value" : "nothing";
}

}  // namespace

void YamlReader::wrong(const YAML::Node& node, const std::string& text) {
  const YAML::Mark mark = node.Mark();
  const std::string place = mark.is_null() ? "" : std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1) + ": ";
  problems_.push_back(file_ + ":" + (place.empty() ? " " : place) + text);
}

std::vector<YamlReader::Entry> YamlReader::entries(const YAML::Node& node, const std::string& what) {
  std::vector<Entry> all;
  if (!node.IsMap()) {
    wrong(node, what + " is " + kind_of(node) + ", allowed: a map");
    return all;
  }
  for (const auto& pair : node) {
    if (!pair.first.IsScalar()) {
      wrong(pair.first, what + ": a key is " + kind_of(pair.first) + ", allowed: a name");
      continue;
    }
    bool twice = false;
    for (const Entry& known : all) twice = twice || known.first.Scalar() == pair.first.Scalar();
    if (twice) wrong(pair.first, what + ": '" + pair.first.Scalar() + "' stands twice");
    if (!twice) all.emplace_back(pair.first, pair.second);
  }
  return all;
}

std::vector<YAML::Node> YamlReader::fields(const YAML::Node& node, const std::string& what,
                                           std::initializer_list<const char*> keys) {
  const std::vector<std::string> names(keys.begin(), keys.end());
  std::vector<YAML::Node> found(names.size(), YAML::Node(YAML::NodeType::Null));
  for (const Entry& entry : entries(node, what)) {
    const std::string& key = entry.first.Scalar();
    bool known = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] != key) continue;
      found[i].reset(entry.second);
      known = true;
      if (entry.second.IsNull()) wrong(entry.first, what + ": '" + key + "' has no value");
    }
    if (!known) {
      wrong(entry.first, what + ": unknown key '" + key + "'" + bodeflow::detail::meant(key, names) +
                             ", allowed: " + bodeflow::detail::listed(names));
    }
  }
  return found;
}

bool YamlReader::scalar(const YAML::Node& node, const std::string& what) {
  if (node.IsScalar()) return true;
  wrong(node, what + " is " + kind_of(node) + ", allowed: a value");
  return false;
}

std::string YamlReader::text(const YAML::Node& node, const std::string& what) {
  return scalar(node, what) ? node.Scalar() : std::string();
}

std::optional<double> YamlReader::number(const YAML::Node& node, const std::string& what, const std::string& unit) {
  if (!scalar(node, what)) return std::nullopt;
  const auto value = bodeflow::convert(node.Scalar(), unit);
  if (value) return *value;
  wrong(node, what + ": " + value.error().text);
  return std::nullopt;
}

std::optional<long long> YamlReader::integer(const YAML::Node& node, const std::string& what, long long least,
                                             long long greatest) {
  if (!scalar(node, what)) return std::nullopt;
  const std::string& text = node.Scalar();
  const bool hexadecimal = text.rfind("0x", 0) == 0 || text.rfind("0X", 0) == 0;
  const char* begin = text.c_str() + (hexadecimal ? 2 : 0);
  const std::string allowed = std::to_string(least) + " to " + std::to_string(greatest) + ", decimal or 0x...";
  const std::string digits = hexadecimal ? "0123456789abcdefABCDEF" : "0123456789";
  const std::size_t sign = !hexadecimal && *begin == '-' ? 1 : 0;
  const std::string number = std::string(begin).substr(sign);
  const bool octal = !hexadecimal && number.size() > 1 && number[0] == '0';
  constexpr std::size_t kMostDigits = 15;
  if (number.empty() || number.size() > kMostDigits || octal || number.find_first_not_of(digits) != std::string::npos) {
    wrong(node, what + ": '" + text + "' is no whole number, allowed: " + allowed);
    return std::nullopt;
  }
  const long long size = std::strtoll(number.c_str(), nullptr, hexadecimal ? 16 : 10);
  const long long value = sign == 1 ? -size : size;
  if (value >= least && value <= greatest) return value;
  wrong(node, what + " is " + text + ", allowed: " + allowed);
  return std::nullopt;
}

std::optional<std::size_t> YamlReader::choice(const YAML::Node& node, const std::string& what,
                                              const std::vector<std::string>& words) {
  if (!scalar(node, what)) return std::nullopt;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (node.Scalar() == words[i]) return i;
  }
  wrong(node, what + " is '" + node.Scalar() + "'" + bodeflow::detail::meant(node.Scalar(), words) +
                  ", allowed: " + bodeflow::detail::listed(words));
  return std::nullopt;
}

std::optional<std::pair<double, double>> YamlReader::range(const YAML::Node& node, const std::string& what,
                                                           const std::string& unit) {
  if (!node.IsSequence() || node.size() != 2) {
    wrong(node, what + " is " + std::string(kind_of(node)) + ", allowed: a list of the least and the greatest value");
    return std::nullopt;
  }
  const auto least = number(node[0], what, unit), greatest = number(node[1], what, unit);
  if (!least || !greatest) return std::nullopt;
  if (*least < *greatest) return std::pair{*least, *greatest};
  wrong(node, what + " are " + records::short_number(*least) + " to " + records::short_number(*greatest) +
                  ", allowed: the lesser one first");
  return std::nullopt;
}

}  // namespace bodeflow::drive::modbus
