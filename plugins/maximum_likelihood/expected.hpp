#pragma once

#include <bodeflow/numerics/error.hpp>

namespace bodeflow::maximum_likelihood {

using numerics::Expected;
using numerics::refused;

/// The refusal of a failed result, to be returned as another type.
template <class T>
auto refusal_in(const Expected<T>& failed) {
  return tl::make_unexpected(failed.error());
}

}  // namespace bodeflow::maximum_likelihood
