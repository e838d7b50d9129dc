#include "model_record.hpp"

#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

#include "records/model.hpp"
#include "records/record_arrays.hpp"
#include "records/response_units.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

const double kHz = 1.0 / (2.0 * std::numbers::pi);

/// Unit of a parameter of the partial fractions.
std::string unit_of(const std::string& name, const std::string& response_unit) {
  if (name.rfind("pole", 0) == 0) return "rad/s";
  const bool bare = response_unit.empty() || response_unit == "1";
  if (name.rfind("direct", 0) == 0) return bare ? "1" : response_unit;
  return bare ? "rad/s" : response_unit + " rad/s";
}

void add_signals(const Measured& measured, records::ModelData& m) {
  m.input_name = measured.inputs.names.front();
  m.output_name = measured.outputs.names.front();
  if (measured.inputs.names.size() > 1) m.inputs = measured.inputs;
  if (measured.outputs.names.size() > 1) m.outputs = measured.outputs;
}

void add_reduction(const Reduction& reduction, Eigen::Index order, RecordBuilder& r) {
  r.set("fitted_poles", static_cast<std::int64_t>(order));
  r.set("states_before", static_cast<std::int64_t>(reduction.states_before));
  r.set("reduction_change", reduction.rms_change);
  if (reduction.hankel_singular_values.size() == 0) return;
  r.set("reduction_bound", reduction.error_bound);
  if (std::isfinite(reduction.gap())) r.set("hankel_gap", reduction.gap());
  records::put_list<double>(r, "hankel_singular_values", "", reduction.hankel_singular_values);
}

records::ModelData described(const Identification& id, const Measured& measured, const std::string& method,
                             const std::vector<std::string>& warnings) {
  records::ModelData m;
  const auto inputs = static_cast<Eigen::Index>(measured.inputs.names.size());
  m.method = method;
  m.form = "state_space";
  m.order = id.reduction ? id.reduction->system.states() : id.order;
  m.sample_time_s = id.system.sample_time;
  m.state_space = id.matrix(inputs);
  m.poles = id.poles;
  if (id.uncertainty) m.pole_covariance = id.uncertainty->poles;
  if (measured.data.channels() == 1) {
    if (const auto tf = faithful_polynomials(*m.state_space, id.poles, measured.data.omega_rad_s, id.response)) {
      m.numerator = tf->numerator;
      m.denominator = tf->denominator;
      if (const auto zeros = numerics::roots(numerics::trimmed(tf->numerator))) m.zeros = *zeros;
    }
  }
  if (id.fractions && id.uncertainty) add_parameters(*id.fractions, *id.uncertainty, measured, m);
  add_signals(measured, m);
  m.warnings = warnings;
  m.conventions = {id.system.sample_time > 0.0
                       ? "sampled signals: hold and delay of the sampling are part of the model"
                       : "continuous in time; a hold of the input, where there is one, is part of the model"};
  if (measured.data.channels() > 1 && !id.reduction)
    m.conventions.push_back("one denominator for all responses; `order` counts its poles");
  if (measured.known_variance) {
    m.cost = id.cost;
    m.expected_cost = static_cast<double>(id.equations) - 0.5 * static_cast<double>(id.parameters);
    m.cost_degrees_of_freedom = 2.0 * *m.expected_cost;
  }
  if (measured.sample_time_s > 0.0) m.sample_rate_hz = 1.0 / measured.sample_time_s;
  m.samples = measured.data.lines();
  m.band_hz = kHz * Eigen::Vector2d(measured.data.omega_rad_s[0], measured.data.omega_rad_s[measured.data.lines() - 1]);
  if (measured.input_amplitude > 0.0) m.input_amplitude = measured.input_amplitude;
  m.data_checksum = measured.checksum;
  return m;
}

}  // namespace

void add_parameters(const FractionParameters& parameters, const Uncertainty& uncertainty, const Measured& measured,
                    records::ModelData& m) {
  if (uncertainty.covariance.size() == 0) return;
  m.parameters = parameters.values;
  m.parameter_names = parameters.names;
  m.covariance = uncertainty.covariance;
  const std::string unit = records::common_unit(measured.units);
  for (const std::string& name : m.parameter_names) m.parameter_units.push_back(unit_of(name, unit));
}

std::optional<numerics::TransferFunction> faithful_polynomials(const numerics::StateSpace& system, const Eigen::VectorXcd& poles,
                                                               const Eigen::VectorXd& omega, const Eigen::MatrixXcd& response) {
  const auto denominator = numerics::polynomial_from_roots(poles);
  if (!denominator || !denominator->allFinite()) return {};
  // det(s I - A + gain B C) = d (1 + gain C (s I - A)^-1 B); a gain that makes both matrices alike keeps the digits of the
  // difference.
  const double size = system.B.norm() * system.C.norm();
  const double gain = size > 0.0 ? std::max(system.A.norm(), 1.0) / size : 1.0;
  const Eigen::MatrixXd closed = system.A - gain * system.B * system.C;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(closed, false);
  if (system.states() > 0 && solver.info() != Eigen::Success) return {};
  const auto shifted = numerics::polynomial_from_roots(system.states() > 0 ? Eigen::VectorXcd(solver.eigenvalues()) : poles);
  if (!shifted || !shifted->allFinite()) return {};
  const Eigen::VectorXd numerator = (*shifted - *denominator) / gain + system.D(0, 0) * *denominator;
  const numerics::TransferFunction tf{numerator, *denominator, system.sample_time};
  const Eigen::VectorXcd values = numerics::frequency_response(tf, kHz * omega);
  const double error = (values - response.col(0)).cwiseAbs().maxCoeff();
  if (!(error <= kPolynomialError * response.cwiseAbs().maxCoeff())) return {};
  return tf;
}

RecordBuilder model_record(const Identification& id, const Measured& measured, const std::string& method,
                           const std::vector<std::string>& warnings) {
  RecordBuilder r = records::write_model(described(id, measured, method, warnings));
  const Eigen::MatrixXd error = (measured.data.response - id.response).cwiseAbs();
  r.set("relative_error", id.error());
  r.set("rms_error", error.norm() / std::sqrt(static_cast<double>(error.size())));
  r.set("max_error", error.maxCoeff());
  const auto all =
      id.system.states() * static_cast<Eigen::Index>(std::min(measured.inputs.names.size(), measured.outputs.names.size()));
  r.set("states", static_cast<std::int64_t>(id.reduction ? id.reduction->system.states() : all));
  if (id.reduction) add_reduction(*id.reduction, id.order, r);
  r.set("iterations", static_cast<std::int64_t>(id.course.errors.size()));
  r.set("best_iteration", static_cast<std::int64_t>(id.course.best + 1));
  r.set("converged", id.course.converged);
  r.set("reason", id.course.reason);
  r.set("reflected_poles", static_cast<std::int64_t>(id.reflected));
  if (id.prewarp_rad_s) r.set("prewarp", *id.prewarp_rad_s);
  if (id.refinement) r.set("refinement", id.refinement->reason);
  if (id.uncertainty)
    r.set("covariance_method",
          measured.known_variance ? "inverse Fisher information" : "inverse Fisher information, noise from the residuals");
  records::put_list<double>(
      r, "iteration_error", "1",
      Eigen::Map<const Eigen::VectorXd>(id.course.errors.data(), static_cast<Eigen::Index>(id.course.errors.size())));
  return r;
}

RecordBuilder order_scan_record(const OrderScan& scan) {
  const auto size = static_cast<Eigen::Index>(scan.orders.size());
  Eigen::MatrixXd columns(size, 8);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ScannedOrder& one = scan.orders[static_cast<std::size_t>(i)];
    columns.row(i) << static_cast<double>(one.order), static_cast<double>(one.parameters), one.cost, one.error, one.aic, one.mdl,
        one.odd_even.value_or(NAN), one.repeat.value_or(NAN);
  }
  RecordBuilder r("order_scan");
  r.set("chosen", static_cast<std::int64_t>(scan.orders[scan.proposed].order));
  r.set("rule", scan.reason);
  const char* names[] = {"order", "parameter_count", "cost", "relative_error", "aic", "mdl", "odd_even_error", "repeat_error"};
  for (Eigen::Index c = 0; c < columns.cols(); ++c) records::put_list<double>(r, names[c], "1", columns.col(c));
  return r;
}

RecordBuilder residual_record(const Measured& measured, const Eigen::MatrixXcd& model, const std::string& method) {
  const Eigen::MatrixXcd& response = measured.data.response;
  const Eigen::MatrixXcd error = response - model;
  RecordBuilder r("residual");
  r.set("method", method);
  r.set("output_names", measured.outputs.names);
  r.set("input_name", measured.inputs.names.front());
  r.set("input_names", measured.inputs.names);
  const auto shape =
      std::vector<std::uint64_t>{static_cast<std::uint64_t>(error.rows()), static_cast<std::uint64_t>(error.cols())};
  const std::string unit = records::common_unit(measured.units);
  records::put_list<double>(r, "frequency", "Hz", kHz * measured.data.omega_rad_s);
  records::put<std::complex<double>>(r, "response", unit, shape, response);
  records::put<std::complex<double>>(r, "model_response", unit, shape, model);
  records::put_matrix(r, "relative_error", "1", error.cwiseAbs().cwiseQuotient(response.cwiseAbs()));
  if (measured.deviation.size() > 0 && measured.deviation.minCoeff() > 0.0)
    records::put<std::complex<double>>(r, "residual", "1", shape,
                                       error.cwiseQuotient(measured.deviation.cast<std::complex<double>>()));
  return r;
}

}  // namespace bodeflow::sanathanan_koerner
