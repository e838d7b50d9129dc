#pragma once

#include <bodeflow/block.hpp>
#include <memory>

#include "base_model.hpp"

namespace bodeflow::residual {

/// Describes the parameters that declare a base model: `base`, `input`, `computation_delay`.
void describe_base(Describe& d);

/// The base model that they declare.
std::unique_ptr<const BaseModel> base_model(const Parameters& p);

}  // namespace bodeflow::residual
