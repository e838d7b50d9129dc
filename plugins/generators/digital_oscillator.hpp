#pragma once

#include <bodeflow/numerics/random.hpp>
#include <cstdint>
#include <vector>

namespace bodeflow::generators {

/// Widths of a numerically controlled oscillator: accumulator of B bits, table of 2^T entries, words of A bits.
struct OscillatorBits {
  int accumulator = 32;
  int table = 12;
  int amplitude = 16;
};

/// Direct digital synthesis: a phase accumulator that addresses a table of a sine.
///
/// acc[n+1] = acc[n] + W mod 2^B, y[n] = table[acc[n] >> (B - T)], table[i] = round((2^(A-1) - 1) sin(2 pi i / 2^T)) / (2^(A-1) -
/// 1). Dropping B - T bits of the phase puts spurs beside the sine, the strongest below it by at least 6.02 T - 3.92 dB, reached
/// where the dropped bits of W are a one and zeros (Nicholas & Samueli 1987); rounding the words adds about 6.02 A + 1.76 dB of
/// noise or weaker spurs. Phase dithering adds a uniform random number of the dropped bits to the phase first: the spurs become
/// white noise of about the same power in all. Reference: H. T. Nicholas, H. Samueli, "An analysis of the output spectrum of
/// direct digital frequency synthesizers in the presence of phase-accumulator truncation", Proc. 41st Frequency Control
/// Symposium, 1987.
class DigitalOscillator {
 public:
  /// 2 <= B <= 48, 1 <= T <= min(B, 20), 2 <= A <= 32.
  explicit DigitalOscillator(const OscillatorBits& bits);

  /// Back to a phase in units of 2^-64 cycles, the rest below 2^-B cycles dropped.
  void start(std::uint64_t phase64) { accumulator_ = phase64 >> (64 - bits_); }
  /// The word for a step in units of 2^-64 cycles: rounded to a multiple of 2^-B cycles.
  std::uint64_t word_of(std::uint64_t step64) const;
  void tune(std::uint64_t word) { word_ = word; }

  double next() { return table_[step() >> dropped_]; }
  double next(numerics::Random& dither);

 private:
  std::uint64_t step() {
    const std::uint64_t phase = accumulator_;
    accumulator_ = (accumulator_ + word_) & mask_;
    return phase;
  }

  int bits_, dropped_;
  std::uint64_t mask_;
  std::vector<double> table_;
  std::uint64_t accumulator_ = 0, word_ = 0;
};

}  // namespace bodeflow::generators
