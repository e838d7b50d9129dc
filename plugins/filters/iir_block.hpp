#pragma once

#include <bodeflow/numerics/iir_design.hpp>

#include "section_block.hpp"

namespace bodeflow::filters {

/// A recursive filter by the classical families, on every channel.
class Iir final : public SectionBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 protected:
  std::vector<BankFilter> design(double rate_hz) const override;
  std::string kind() const override;

 private:
  numerics::IirDesign design_;
  std::vector<double> edges_hz_;
};

}  // namespace bodeflow::filters
