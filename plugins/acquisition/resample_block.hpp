#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "resampler.hpp"

namespace bodeflow::acquisition {

/// acquisition.resample: a stream at another sample rate, or on another clock.
class Resample final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;

 private:
  std::int64_t buffer_for(const StreamFacts& x) const;

  Rate rate_;
  std::optional<std::string> clock_;
  std::optional<double> buffer_s_;
  ResamplerSpec spec_;
  ResamplerPlan plan_;
  Rate input_rate_;
  int channels_ = 0;
  std::optional<Resampler> resampler_;
};

}  // namespace bodeflow::acquisition
