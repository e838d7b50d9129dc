#pragma once

#include <bodeflow/plant.hpp>
#include <string>
#include <vector>

#include "isolate.hpp"
#include "parameter_text.hpp"
#include "plugin_file.hpp"

namespace bodeflow::testing {

/// One check of an effect or a base model. `run` throws Failure where the part is at fault, Skip where the check does not apply.
struct PartCheck {
  std::string name;
  std::function<void(const Step&)> run;
};

/// The checks of an effect: its description, parameters and starts, and that its functions are finite and pure and leave foreign
/// memory alone.
std::vector<PartCheck> effect_checks(const bf_factory& factory);

/// The checks of a base model with these values of its described parameters.
std::vector<PartCheck> base_checks(const bf_factory& factory, const std::vector<StoredValue>& values);

/// What is wrong with the parameters that a part states, or "".
std::string problem_of(const std::vector<FitParameter>& parameters);
/// What is wrong with starts for these parameters, or "".
std::string problem_of(const std::vector<std::vector<double>>& starts, const std::vector<FitParameter>& parameters);

/// Like ==, where NaN equals NaN and 0 does not equal -0: the same bits.
bool same_bits(const double* a, const double* b, std::size_t count);

}  // namespace bodeflow::testing
