#pragma once

#include <string>
#include <vector>

#include "identification.hpp"

namespace bodeflow::koopmans_levin {

/// What speaks against a model, each with what to do: a ratio that is not determined or that matters, no order found, errors that
/// are not white (with their band), an offset, unstable poles, few lines, a search that did not end, a noise matrix that is
/// wrong. highest_order: of the scan. periodic: the records hold whole periods, which need no transient.
std::vector<std::string> model_warnings(const Identification& found, const Settings& settings, double sample_rate_hz,
                                        bool periodic);

}  // namespace bodeflow::koopmans_levin
