#pragma once

#include <Eigen/Core>
#include <functional>

#include "motor_fit.hpp"

namespace bodeflow::frisch {

/// What stands between the samples of the input and the motor, and between the motor and the samples of the output.
struct Sampling {
  double hold_s = 0.0;   ///< the input is a staircase of steps this long, whose samples were taken; 0: it is not held
  double delay_s = 0.0;  ///< of the output against the input, beside the hold
};

/// The motor between samples of a staircase input and samples of its output, both every `hold_s`, at exp(j omega hold_s):
///   sum_i r_i (e^(p_i T) - 1)/p_i / (e^(j omega T) - e^(p_i T)),  p_i the poles (real and apart, as all parameters are
///   positive),
/// r_i their residues. Exact also where input and output are then decimated together, as long as the input has no lines of its
/// own above the new Nyquist frequency.
std::complex<double> held_response(const MotorModel& model, double omega, double hold_s);

/// The factor that refers outputs to a motor in continuous time without delay: G(j omega) / held_response e^(j omega delay).
Eigen::VectorXcd continuous_factor(const MotorModel& model, const Eigen::VectorXd& omega, const Sampling& sampling);

/// The fit of a motor behind a hold and a delay: `fit` gets the factors by which to multiply outputs, or responses, and gives the
/// model of what comes out; the factors follow from that model, and so on until it rests. They hardly depend on it (1e-3 of the
/// change at 200 us, 100 Hz), so a few turns give full accuracy.
/// Errors: those of `fit`; a line at or above half the rate of the hold; a model that does not come to rest in 50 turns.
using FitToFactors = std::function<Expected<MotorFit>(const Eigen::VectorXcd& factor)>;
Expected<MotorFit> fit_behind_hold(const FitToFactors& fit, const Eigen::VectorXd& omega, const Sampling& sampling);

}  // namespace bodeflow::frisch
