#pragma once

#include "section_block.hpp"

namespace bodeflow::filters {

/// Kallen's narrow band-pass filters: one channel for each frequency.
class NarrowBandPassBank final : public SectionBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 protected:
  std::vector<BankFilter> design(double rate_hz) const override;
  std::string kind() const override;

 private:
  numerics::NarrowBandPass one(double frequency_hz, double rate_hz) const;

  std::vector<double> frequencies_hz_;
  double radius_ = 0.9;
  int sections_ = 2;
  double spacing_ = 0.0;
  bool narrow_low_ = false;
};

}  // namespace bodeflow::filters
