#include "plugins/description.hpp"

#include <algorithm>
#include <cstdlib>

namespace bodeflow {

ParameterView::ParameterView(const ParameterValue& value) {
  strings_.reserve(value.strings.size());
  for (const std::string& text : value.strings) strings_.push_back(text.c_str());
  c_.struct_size = sizeof c_;
  c_.type = value.type;
  c_.given = value.given ? 1 : 0;
  c_.rows = value.rows;
  c_.columns = value.columns;
  c_.integer = value.integer;
  c_.numbers = value.numbers.data();
  c_.integers = value.integers.data();
  c_.strings = strings_.data();
}

bool BlockDescription::has_role(std::string_view role) const {
  return std::find(roles.begin(), roles.end(), role) != roles.end();
}

const PortDescription* BlockDescription::port(std::uint32_t direction, const std::string& name) const {
  const auto it = std::find_if(ports.begin(), ports.end(),
                               [&](const PortDescription& p) { return p.direction == direction && p.name == name; });
  return it == ports.end() ? nullptr : &*it;
}

int BlockDescription::parameter(const std::string& name) const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterDescription& p = parameters[i];
    if (p.name == name || std::find(p.aliases.begin(), p.aliases.end(), name) != p.aliases.end()) return static_cast<int>(i);
  }
  return -1;
}

int BlockDescription::count(std::uint32_t kind, std::uint32_t direction) const {
  return static_cast<int>(std::count_if(ports.begin(), ports.end(),
                                        [&](const PortDescription& p) { return p.kind == kind && p.direction == direction; }));
}

const PortDescription& BlockDescription::port_at(std::uint32_t kind, std::uint32_t direction, int index) const {
  for (const PortDescription& p : ports) {
    if (p.kind == kind && p.direction == direction && p.index == index) return p;
  }
  std::abort();  // the caller's bug: indices come from `count`
}

}  // namespace bodeflow
