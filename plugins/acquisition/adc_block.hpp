#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/random.hpp>
#include <optional>

#include "anti_alias.hpp"
#include "aperture.hpp"
#include "quantiser.hpp"

namespace bodeflow::acquisition {

/// acquisition.adc: what an analog-to-digital converter makes of a signal that is given more densely.
class Adc final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  struct Channel {
    std::optional<AnalogFilter> filter;
    ApertureSampler sampler;
  };

  void check_finite(std::span<const double> x, int channel, std::uint64_t first) const;
  void count_clipped(int channel, std::uint64_t sample);
  double attenuation_db(double frequency_hz) const;

  std::int64_t factor_ = 1;
  int order_ = 0;
  double corner_hz_ = 0.0, jitter_s_ = 0.0;
  ConverterSpec spec_;
  std::optional<Quantiser> quantiser_;
  Rate input_rate_;
  std::string unit_;
  int channels_ = 0;
  std::vector<Channel> state_;
  std::vector<double> filtered_, displacement_;
  numerics::Random random_{0};
  std::uint64_t seed_ = 0;
  std::uint64_t samples_ = 0, clipped_ = 0, first_clipped_ = 0;
  int first_clipped_channel_ = 0;
};

}  // namespace bodeflow::acquisition
