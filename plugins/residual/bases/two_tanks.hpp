#pragma once

#include <bodeflow/base_model.hpp>
#include <string>

namespace bodeflow::residual {

/// residual.two_tanks: a pump fills the upper tank, which runs out into the lower one, whose level is measured.
class TwoTanks final : public BaseModel {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override;
  Timing timing() const override { return timing_; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;
  bool has_laws() const override { return torricelli_; }
  Reaction react(const double* v, const double* known, std::size_t place, const Signals& signals) const override;

 private:
  bool torricelli_ = false;
  double level_ = 1.0;
  std::string level_unit_ = "m";
  std::string input_unit_ = "V";
  Timing timing_;
};

}  // namespace bodeflow::residual
