#pragma once

#include "identifier_block.hpp"

namespace bodeflow::sanathanan_koerner {

/// sanathanan_koerner.model: a rational model of a frequency response of any order, of one or several inputs and outputs.
class ModelBlock final : public IdentifierBlock {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

 private:
  std::string id() const override { return "sanathanan_koerner.model"; }
  Settings settings_for(const Measured& measured) const override;

  Settings settings_;
  bool in_z_ = false;
};

}  // namespace bodeflow::sanathanan_koerner
