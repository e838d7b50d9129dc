#pragma once

#include <bodeflow/base_model.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// A base model with declared values, without a host: numbers in the parameter's own unit. Other parameters have their defaults.
using Declared = std::pair<std::string, std::variant<bool, std::int64_t, double, std::string>>;

template <class Base>
std::shared_ptr<const Base> declared_base(const std::vector<Declared>& values = {}) {
  bodeflow::BlockDraft draft;
  bodeflow::Describe describe(draft);
  Base::describe(describe);
  std::vector<bodeflow::StoredValue> stored;
  for (const bodeflow::ParameterDraft& p : draft.parameters) {
    bodeflow::StoredValue v = p.fallback;
    for (const Declared& d : values) {
      if (d.first != p.name) continue;
      v = std::visit([](const auto& x) { return bodeflow::stored_value(x); }, d.second);
      v.type = p.type;
      v.given = true;
    }
    stored.push_back(v);
  }
  auto base = std::make_shared<Base>();
  base->configure(bodeflow::Parameters(draft.parameters, stored));
  return base;
}
