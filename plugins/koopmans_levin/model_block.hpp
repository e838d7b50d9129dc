#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "identification.hpp"
#include "records/signals.hpp"

namespace bodeflow::koopmans_levin {

/// koopmans_levin.model: a discrete-time model from one record whose input and output both carry white noise.
class ModelBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut order_scan{1, "order_scan"};
  static constexpr MessageOut whiteness{2, "whiteness"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void collect(std::span<const double> samples, const char* name, std::vector<double>& into) const;
  Settings settings_for(std::int64_t samples) const;

  Settings settings_;  // bands apart: they depend on the number of samples
  std::string band_, noise_band_;
  std::int64_t most_samples_ = 0;
  std::int64_t wanted_ = 0;  // 0: all
  double rate_hz_ = 1.0;
  records::Signals input_signal_, output_signal_;
  double period_ = 0.0;  // of the excitation, samples; 0: not known
  std::vector<double> u_, y_;
};

}  // namespace bodeflow::koopmans_levin
