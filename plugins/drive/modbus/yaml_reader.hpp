#pragma once

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bodeflow::drive::modbus {

/// Reads typed values from the nodes of a YAML file and keeps all that is wrong, as file:line:column.
class YamlReader {
 public:
  using Entry = std::pair<YAML::Node, YAML::Node>;

  explicit YamlReader(std::string file) : file_(std::move(file)) {}

  void wrong(const YAML::Node& node, const std::string& text);
  const std::vector<std::string>& problems() const { return problems_; }

  /// The entries of a map in their order; a key that stands twice, or no map at all, is a problem.
  std::vector<Entry> entries(const YAML::Node& node, const std::string& what);
  /// The entries of a map with these keys, in the order of `keys`; a null node where one is absent. Other keys are problems.
  std::vector<YAML::Node> fields(const YAML::Node& node, const std::string& what, std::initializer_list<const char*> keys);

  std::string text(const YAML::Node& node, const std::string& what);
  /// A number in that unit: "100 Hz", 0.1.
  std::optional<double> number(const YAML::Node& node, const std::string& what, const std::string& unit);
  /// A whole number, decimal or hexadecimal (0x...).
  std::optional<long long> integer(const YAML::Node& node, const std::string& what, long long least, long long greatest);
  /// The place of a word among those allowed.
  std::optional<std::size_t> choice(const YAML::Node& node, const std::string& what, const std::vector<std::string>& words);
  /// Two numbers in rising order.
  std::optional<std::pair<double, double>> range(const YAML::Node& node, const std::string& what, const std::string& unit);

 private:
  bool scalar(const YAML::Node& node, const std::string& what);

  std::string file_;
  std::vector<std::string> problems_;
};

}  // namespace bodeflow::drive::modbus
