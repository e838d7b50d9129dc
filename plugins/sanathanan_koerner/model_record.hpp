#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "identification.hpp"
#include "measured.hpp"
#include "records/model.hpp"

namespace bodeflow::sanathanan_koerner {

/// The record `model` in form state_space, by the block of that id. Of one input and output it has `numerator` and `denominator`
/// too where they reproduce the response (kPolynomialError), for readers that need them. Beside what records/model.hpp writes:
/// attributes `relative_error` (weighted residual over the weighted data), `rms_error`, `max_error` (of |G - model|, not
/// weighted), `iterations`, `best_iteration`, `converged`, `reason`, `reflected_poles`, `prewarp` [rad/s], `refinement`,
/// `states`; array `iteration_error`. Of a reduced model also `fitted_poles`, `states_before`, `reduction_change` (rms over the
/// lines), `reduction_bound`, `hankel_gap`; array `hankel_singular_values`, and `order` is the number of states.
RecordBuilder model_record(const Identification& id, const Measured& measured, const std::string& method,
                           const std::vector<std::string>& warnings);

/// Puts the parameters of the partial fractions and their covariance, where it is known, into what a model record is made from.
void add_parameters(const FractionParameters& parameters, const Uncertainty& uncertainty, const Measured& measured,
                    records::ModelData& model);

/// The record `order_scan`: attributes `chosen`, `rule`; arrays `order`, `parameter_count`, `cost`, `relative_error`, `aic`,
/// `mdl`, `odd_even_error`, `repeat_error` (NaN where there is none).
RecordBuilder order_scan_record(const OrderScan& scan);

/// The record `residual`: arrays, lines x channels: `response`, `model_response`, `relative_error`, `residual` (over its standard
/// deviation, where that is known); `frequency` [Hz].
RecordBuilder residual_record(const Measured& measured, const Eigen::MatrixXcd& model, const std::string& method);

/// What the user should know: residual against noise, reflected poles, few lines, a scan without end, no convergence.
std::vector<std::string> model_warnings(const Identification& id, const Measured& measured, const Settings& settings);

/// Largest difference between the response of the polynomials and that of the state space, over the largest response.
inline constexpr double kPolynomialError = 1e-8;

/// Numerator and denominator where they reproduce the response at the lines within kPolynomialError; one channel, in s or z.
std::optional<numerics::TransferFunction> faithful_polynomials(const numerics::StateSpace& system, const Eigen::VectorXcd& poles,
                                                               const Eigen::VectorXd& omega_rad_s,
                                                               const Eigen::MatrixXcd& response);

}  // namespace bodeflow::sanathanan_koerner
