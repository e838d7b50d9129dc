#pragma once

#include "disturbance_filter.hpp"
#include "section_block.hpp"

namespace bodeflow::filters {

/// Takes out disturbances that are steps, ramps or sinusoids, and what is above a band.
class Disturbance final : public SectionBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 protected:
  std::vector<BankFilter> design(double rate_hz) const override;
  std::string kind() const override;

 private:
  DisturbanceDesign at(double rate_hz) const;

  int steps_ = 1;
  std::vector<double> sinusoids_hz_;
  double width_hz_ = 0.0;
  double low_hz_ = 0.0;
  double high_hz_ = 0.0;
  int order_ = 2;
  bool bessel_ = false;
};

}  // namespace bodeflow::filters
