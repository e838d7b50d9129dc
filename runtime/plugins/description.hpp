#pragma once

#include <bodeflow/abi.h>

#include <bodeflow/effect_description.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow {

/// An owned parameter value; the same fields as bf_parameter_value, which `ParameterView` borrows from it.
struct ParameterValue {
  std::uint32_t type = 0;  ///< BF_BOOL ... BF_MATRIX
  bool given = false;      ///< written in the graph
  std::uint32_t rows = 0;  ///< 1 for a scalar with a value, 0: none
  std::uint32_t columns = 1;
  std::int64_t integer = 0;
  std::vector<double> numbers;
  std::vector<std::int64_t> integers;
  std::vector<std::string> strings;

  bool operator==(const ParameterValue&) const = default;
};

/// The bf_parameter_value of an owned value; valid while the value lives unchanged.
class ParameterView {
 public:
  explicit ParameterView(const ParameterValue& value);
  ParameterView(ParameterView&&) = default;
  ParameterView& operator=(ParameterView&&) = default;
  const bf_parameter_value& c() const { return c_; }

 private:
  std::vector<const char*> strings_;
  bf_parameter_value c_{};
};

struct PortDescription {
  std::uint32_t kind = BF_STREAM;
  std::uint32_t direction = BF_IN;
  bool optional = false;
  std::uint32_t element = BF_ANY;
  std::string name;
  std::string record_type;  ///< "" : any
  std::string doc;
  int index = 0;  ///< among the ports of the same kind and direction: what the ABI counts by

  bool operator==(const PortDescription&) const = default;
};

struct ParameterDescription {
  std::string name;
  std::uint32_t type = BF_NUMBER;
  bool required = false;
  bool live = false;
  bool exclusive_minimum = false;
  bool exclusive_maximum = false;
  std::string unit;
  std::string doc;
  std::vector<std::string> choices;
  std::vector<std::string> aliases;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  ParameterValue fallback;

  bool operator==(const ParameterDescription&) const = default;
};

/// What a block's static descriptor says, owned: it outlives the plugin and comes from the probe's cache. A base model's too:
/// then without ports, flags, roles and cost.
struct BlockDescription {
  std::string id;
  std::string summary;
  std::string doc;
  std::string references;
  std::vector<std::string> roles;
  bool realtime_safe = false;
  bool in_place = false;
  bool asynchronous = false;
  double cost_ns = 0.0;
  std::vector<PortDescription> ports;
  std::vector<ParameterDescription> parameters;

  bool operator==(const BlockDescription&) const = default;

  /// Whether the block says that it is one: "device", "actuator", "resampler" ...
  bool has_role(std::string_view role) const;
  /// The port of that name and direction, or nullptr.
  const PortDescription* port(std::uint32_t direction, const std::string& name) const;
  /// Index in `parameters` by name or alias, or -1.
  int parameter(const std::string& name) const;
  /// How many ports of that kind and direction there are.
  int count(std::uint32_t kind, std::uint32_t direction) const;
  /// The port by kind, direction and index.
  const PortDescription& port_at(std::uint32_t kind, std::uint32_t direction, int index) const;
};

/// A plugin as the probe found it.
struct PluginDescription {
  std::string file;  ///< absolute path, links resolved
  std::string name;
  std::string version;
  std::string build;
  std::string sha256;  ///< of the file; empty for a file that is refused before it was hashed
  std::vector<BlockDescription> blocks;
  std::string refused;  ///< why it can't be used; empty: it can
  std::vector<EffectDescription> effects;
  std::vector<BlockDescription> base_models;
};

}  // namespace bodeflow
