#pragma once

#include <bodeflow/block.hpp>
#include <complex>
#include <vector>

#include "sine_window.hpp"

namespace bodeflow::spectrum {

/// spectrum.goertzel: amplitude and phase of a few frequencies, over a sliding window.
class Goertzel final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<std::complex<double>> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  std::vector<double> frequencies_hz_;
  std::int64_t window_ = 0;
  std::int64_t hop_ = 0;

  std::size_t channels_ = 0;
  std::vector<std::int64_t> cycles_;           // of each frequency in a window
  std::vector<SineTable> tables_;              // one a frequency
  std::vector<std::vector<SineWindow>> sums_;  // of hops, one a channel and frequency
  std::size_t at_ = 0;                         // in the window
  std::uint64_t samples_ = 0;
};

}  // namespace bodeflow::spectrum
