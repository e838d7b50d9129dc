#pragma once

#include <complex>

#include "rst_design.hpp"

namespace bodeflow::adaptive_control {

/// What a design must keep to be used.
struct AcceptanceLimits {
  double pole_radius = 0.98;  ///< of R without its prescribed factor
  double residual = 0.5;      ///< of the fit
  double sensitivity = 2.5;   ///< largest 1 / |1 + L| at the points of fitting
};

enum class Refusal { none, no_solution, controller_pole, residual, sensitivity };

struct Verdict {
  Refusal refusal = Refusal::none;
  double value = 0.0;  ///< what was found, beyond its limit
};

/// Whether all roots of the monic polynomial of degree n lie inside the circle of that radius. Method: Schur-Cohn in Jury's form,
/// cost n^2, no roots.
bool roots_inside(const Coefficients& polynomial, int n, double radius);

/// The largest 1 / |1 + G S / R| at the points of fitting.
double sensitivity_at_points(const RstDesign& design, const Rst& controller, const std::complex<double>* g);

/// The first limit that the design breaks. Judged at the points of fitting alone: a necessary condition, no proof of stability.
Verdict judge(const RstDesign& design, const RstResult& result, const std::complex<double>* g, const AcceptanceLimits& limits);

/// The verdict in words, for a log.
const char* words_of(Refusal refusal);

}  // namespace bodeflow::adaptive_control
