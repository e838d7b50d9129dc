#pragma once

#include <optional>
#include <string>
#include <vector>

#include "closed_loop.hpp"
#include "desired_response.hpp"
#include "rst_design.hpp"

namespace bodeflow::adaptive_control {

/// What is known of the plant and its surroundings beside the demands; nothing where left out.
struct PlantKnowledge {
  std::optional<int> order;          ///< degree of its denominator
  std::optional<double> omega_180;   ///< where its phase is -180 degrees [rad/s]
  std::optional<double> delay_s;     ///< true delay
  std::optional<double> anti_alias;  ///< bandwidth of the filter before the sampler [rad/s]
};

/// Advice on the choice of design parameters.
struct DesignAdvice {
  std::vector<std::string> notes;     ///< what is in order, each with its figure
  std::vector<std::string> warnings;  ///< what is not, with what to do
};

/// The list of section 7.4 of Kallen 1992, step by step: controller structure, frequencies of fitting over about a decade up to
/// omega_-180, bandwidth and degree of A_m, speed of A_o beside it, omega h within 0.2 to 0.6, the anti-alias filter as a delay.
DesignAdvice advice_before(const RstStructure& structure, const DesiredResponse& desired, const PlantKnowledge& plant);

/// What a forgetting factor means for the estimates; a warning below 0.98.
DesignAdvice forgetting_advice(double forgetting);

/// Demands that are too high, as a design shows them: a controller pole on the negative real axis (the control signal rings),
/// S(1) / T(1) off by more than 5 %, M_s above 2.5. `quality` where the plant is known.
DesignAdvice advice_after(const RstResult& result, const std::optional<LoopQuality>& quality, double sensitivity_at_points);

/// The sum of the time constants 1 / |pole| of a polynomial in s [s].
double time_constant(const Eigen::VectorXd& polynomial);

}  // namespace bodeflow::adaptive_control
