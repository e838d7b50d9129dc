#pragma once

#include <bodeflow/record.hpp>
#include <optional>
#include <string>
#include <vector>

#include "measured.hpp"
#include "method.hpp"

namespace bodeflow::sanathanan_koerner {

/// What an identifying block of the family gives.
struct Emission {
  RecordBuilder model, residual;
  std::optional<RecordBuilder> order_scan;
  std::vector<std::string> warnings;
};

/// The records of an identification for the block of that id. Fails with the reason where there is no model.
Emission identified(const std::string& block, const Measured& measured, const std::optional<Measured>& repeated,
                    Settings settings);

}  // namespace bodeflow::sanathanan_koerner
