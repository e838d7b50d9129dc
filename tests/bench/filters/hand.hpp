#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace bench {

inline constexpr std::size_t kTaps = 64;
inline constexpr std::size_t kBiquads = 16;

/// b0, b1, b2, a1, a2 of 16 resonances from 0.05 to 0.9 of the Nyquist frequency.
std::array<std::array<double, 5>, kBiquads> biquad_coefficients();
/// A low-pass filter of 64 taps.
std::array<double, kTaps> fir_coefficients();

/// `samples` zeros in chunks of 1024 through the 64 taps, 32 outputs at a time in registers.
void hand_fir(std::size_t samples);

/// The same input through the 16 biquads side by side, all of a sample at once; the outputs of a sample stay together (frames),
/// or are dealt out to a channel each, which is what the bank gives.
void hand_biquads_frames(std::size_t samples);
void hand_biquads_channels(std::size_t samples);

}  // namespace bench
