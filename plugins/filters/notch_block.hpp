#pragma once

#include "section_block.hpp"

namespace bodeflow::filters {

/// Takes single frequencies out.
class Notch final : public SectionBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 protected:
  std::vector<BankFilter> design(double rate_hz) const override;
  std::string kind() const override;

 private:
  std::vector<double> frequencies_hz_;
  std::vector<double> widths_hz_;
};

}  // namespace bodeflow::filters
