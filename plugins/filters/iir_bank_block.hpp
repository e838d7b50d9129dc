#pragma once

#include <bodeflow/numerics/iir_design.hpp>

#include "section_block.hpp"

namespace bodeflow::filters {

/// Filters of one family with a band each: every channel becomes as many channels as there are bands.
class IirBank final : public SectionBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 protected:
  std::vector<BankFilter> design(double rate_hz) const override;
  std::string kind() const override;

 private:
  numerics::IirDesign design_;
  Matrix bands_hz_;
};

}  // namespace bodeflow::filters
