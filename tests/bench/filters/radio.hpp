#pragma once

#include <cstddef>

namespace bench {

/// GNU Radio: null source -> fir_filter_fff of the 64 taps -> null sink.
void radio_fir(std::size_t samples);

/// GNU Radio: null source -> 16 times iir_filter_ffd (coefficients and states in double, samples in float), a null sink each.
void radio_biquads(std::size_t samples);

}  // namespace bench
