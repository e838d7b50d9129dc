#pragma once

#include "section_block.hpp"

namespace bodeflow::filters {

/// Second-order sections as they are given, in series or side by side.
class Biquads final : public SectionBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 protected:
  std::vector<BankFilter> design(double rate_hz) const override;
  std::string kind() const override;

 private:
  bool bank_ = false;
  numerics::Sections sections_;
};

}  // namespace bodeflow::filters
