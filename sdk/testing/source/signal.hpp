#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>

namespace bodeflow::testing {

/// Test sample n of channel c of input i: noise of unit size that depends on nothing else.
double ordinary_sample(std::size_t input, std::size_t channel, std::uint64_t n);

/// NaN, infinite, denormal, huge, tiny and ordinary values in turn.
double bad_sample(std::size_t input, std::size_t channel, std::uint64_t n);

}  // namespace bodeflow::testing
