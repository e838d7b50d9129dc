#pragma once

#include <bodeflow/plant.hpp>
#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// "gain", or "gain_1", "gain_2" ... of several inputs: real, near 1.
std::vector<FitParameter> gain_parameters(int inputs);

/// The gain of each input by weighted least squares; 1 where there is nothing to tell it from. `measured` has a response of each
/// input in turn, record after record; `model` gives that of input j at a frequency.
std::vector<double> gains_near(std::span<const MeasuredResponse> measured, int inputs,
                               const std::function<std::complex<double>(int input, double frequency_hz)>& model);

}  // namespace bodeflow::residual
