#pragma once

#include <bodeflow/numerics/error.hpp>

namespace bodeflow::residual {

using numerics::Expected;
using numerics::refused;

}  // namespace bodeflow::residual
