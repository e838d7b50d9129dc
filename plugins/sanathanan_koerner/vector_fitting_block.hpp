#pragma once

#include "identifier_block.hpp"

namespace bodeflow::sanathanan_koerner {

/// sanathanan_koerner.vector_fitting: a rational model of a frequency response by relaxed vector fitting.
class VectorFittingBlock final : public IdentifierBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 private:
  std::string id() const override { return "sanathanan_koerner.vector_fitting"; }
  Settings settings_for(const Measured&) const override { return settings_; }

  Settings settings_;
};

}  // namespace bodeflow::sanathanan_koerner
