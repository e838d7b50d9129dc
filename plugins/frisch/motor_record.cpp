#include "motor_record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "physical_parameters.hpp"
#include "records/checksum.hpp"
#include "records/model.hpp"
#include "records/record_arrays.hpp"
#include "records/response.hpp"
#include "records/response_units.hpp"
#include "records/signals.hpp"

namespace bodeflow::frisch {
namespace {

using Complex = std::complex<double>;

const char* method_name(Method method) {
  if (method == Method::frisch) return "Frisch scheme, least squares";
  return method == Method::none ? "without Frisch scheme, least squares" : "maximum likelihood, pooled noise";
}

/// The variances of the poles.
Eigen::Vector2d pole_variance(const MotorFit& fit) {
  const MotorModel& m = fit.model;
  const Eigen::Vector2d pole = poles(m);
  Eigen::Vector2d variance;
  // p^2 + sum p + product = 0: dp = -(p dsum + dproduct) / (2 p + sum).
  const Eigen::Vector4d of_sum(1.0, 1.0, 0.0, 0.0),
      of_product(m.alpha, m.gamma - 2.0 * m.alpha * m.lm_beta, -m.alpha * m.alpha, 0.0);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector4d slope = -(pole[i] * of_sum + of_product) / (2.0 * pole[i] + m.gamma + m.alpha);
    variance[i] = slope.dot(fit.covariance * slope);
  }
  return variance;
}

Eigen::Matrix2d of_real_part(double variance) {
  Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
  m(0, 0) = variance;
  return m;
}

/// The largest |u| of the mean period; nothing where the period is not known.
double largest_input(const Band& band) {
  if (band.period == 0 || band.sample_rate_hz == 0.0) return 0.0;
  // So many places of a long period find its peak to a percent; more would take long.
  constexpr std::int64_t kPlaces = 8192;
  const double from_unitary = 2.0 / std::sqrt(static_cast<double>(band.period));
  const std::int64_t places = std::min(band.period, kPlaces);
  double largest = 0.0;
  for (std::int64_t n = 0; n < places; ++n) {
    const double t = static_cast<double>(n * band.period / places) / band.sample_rate_hz;
    double u = 0.0;
    for (Eigen::Index k = 0; k < band.mean.lines(); ++k) {
      u += (band.mean.input[k] * std::polar(from_unitary, band.mean.omega[k] * t)).real();
    }
    largest = std::max(largest, std::abs(u));
  }
  return largest;
}

std::string checksum_of(const std::vector<Band>& bands) {
  records::Checksum sum;
  const auto add = [&](const Eigen::VectorXcd& values) {
    sum.add({reinterpret_cast<const double*>(values.data()), 2 * static_cast<std::size_t>(values.size())});
  };
  for (const Band& b : bands) {
    add(b.mean.input);
    add(b.mean.output);
  }
  return sum.text();
}

std::vector<std::string> conventions(const MotorContext& c) {
  const Sampling& s = c.settings.sampling;
  std::vector<std::string> all = {
      "one axis of the stator frame, amplitude-invariant Clarke: peak values of a phase, per-phase star equivalent circuit",
      "input: " + c.input_is};
  all.push_back(s.hold_s > 0.0 ? "the input is held for " + records::short_number(1e6 * s.hold_s) +
                                     " us a sample; the model is that of the motor without the hold"
                               : "the input is taken as continuous in time, without hold");
  if (s.delay_s != 0.0) {
    all.push_back("a delay of " + records::short_number(1e6 * s.delay_s) + " us between input and output was taken off the data");
  }
  all.push_back(std::string("method: ") + method_name(c.settings.method));
  return all;
}

records::ModelData model_data(const MotorEstimate& e, const MotorContext& c) {
  const MotorModel& m = e.fit.model;
  const Eigen::Vector2d variance = pole_variance(e.fit);
  records::ModelData d;
  d.method = "frisch.motor";
  d.form = "physical";
  d.order = 2;
  d.delay_s = c.settings.sampling.delay_s;
  d.parameter_names = motor_parameter_names();
  d.parameter_units = {"1/s", "1/s", "1", "H"};
  d.parameters = m.vector();
  d.covariance = e.fit.covariance;
  d.numerator = transfer_numerator(m);
  d.denominator = transfer_denominator(m);
  d.poles = poles(m).cast<Complex>();
  d.zeros = Eigen::VectorXcd::Constant(1, Complex(-m.alpha));
  d.pole_covariance = {of_real_part(variance[0]), of_real_part(variance[1])};
  d.zero_covariance = {of_real_part(e.fit.covariance(1, 1))};
  const Band& first = c.bands.front();
  d.input_name = first.input_name;
  d.output_name = first.output_name;
  d.input_unit = first.input_unit;
  d.output_unit = first.output_unit;
  d.conventions = conventions(c);
  d.warnings = motor_warnings(e, c);
  d.cost = e.fit.cost;
  if (std::isfinite(e.fit.expected_cost)) {
    const double lines = static_cast<double>(e.omega.size()), count = MotorModel::kParameters;
    d.expected_cost = e.fit.expected_cost;
    d.cost_degrees_of_freedom = 2.0 * lines - count;
    d.aic = 2.0 * e.fit.cost + 2.0 * count;
    d.mdl = 2.0 * e.fit.cost + count * std::log(2.0 * lines);
  }
  double largest = 0.0, samples = 0.0;
  for (const Band& b : c.bands) {
    largest = std::max(largest, largest_input(b));
    samples += b.periods * static_cast<double>(b.period);
  }
  if (largest > 0.0) d.input_amplitude = largest;
  if (samples > 0.0) d.samples = static_cast<std::int64_t>(samples);
  d.band_hz = Eigen::Vector2d(e.omega.minCoeff(), e.omega.maxCoeff()) / (2.0 * std::numbers::pi);
  d.data_checksum = checksum_of(c.bands);
  return d;
}

RecordBuilder parameters_record(const std::vector<std::string>& names, const std::vector<std::string>& units,
                                const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance, const std::string& assumption) {
  RecordBuilder r("parameters");
  r.set("parameter_names", names);
  r.set("parameter_units", units);
  r.set("assumption", assumption);
  records::put_list<double>(r, "parameters", "", values);
  records::put_matrix(r, "covariance", "", covariance);
  records::put_list<double>(r, "std", "", covariance.diagonal().cwiseMax(0.0).cwiseSqrt().eval());
  return r;
}

}  // namespace

RecordBuilder model_record(const MotorEstimate& e, const MotorContext& c) {
  RecordBuilder r = records::write_model(model_data(e, c));
  const Intervals in = intervals(e.fit);
  records::put_list<double>(r, "bias", "", e.fit.bias);
  records::put_list<double>(r, "interval_low", "", in.lower);
  records::put_list<double>(r, "interval_high", "", in.upper);
  const auto put_std = [&](const char* name, const std::string& unit, const std::vector<double>& variance) {
    if (variance.empty()) return;
    const Eigen::Map<const Eigen::VectorXd> v(variance.data(), static_cast<Eigen::Index>(variance.size()));
    records::put_list<double>(r, name, unit, v.cwiseSqrt().eval());
  };
  put_std("input_noise_std", c.bands.front().input_unit, e.input_noise_variance);
  put_std("output_noise_std", c.bands.front().output_unit, e.output_noise_variance);
  return r;
}

RecordBuilder identifiable_record(const MotorEstimate& e) {
  const IdentifiableParameters p = identifiable_parameters(e.fit);
  const Eigen::Vector4d values(p.stator_resistance_ohm, p.stator_inductance_h, p.rotor_time_constant_s, p.leakage_inductance_h);
  return parameters_record({"Rs", "Ls", "Lr/Rr", "sigma"}, {"ohm", "H", "s", "H"}, values, p.covariance,
                           "none: what voltage and current at standstill determine");
}

RecordBuilder equal_inductance_record(const MotorEstimate& e) {
  const EqualInductanceParameters p = equal_inductance_parameters(e.fit);
  Eigen::VectorXd values(5);
  values << p.stator_resistance_ohm, p.rotor_resistance_ohm, p.stator_inductance_h, p.rotor_inductance_h, p.mutual_inductance_h;
  return parameters_record({"Rs", "Rr", "Ls", "Lr", "Lm"}, {"ohm", "ohm", "H", "H", "H"}, values, p.covariance,
                           "Ls = Lr: another ratio gives other Rr, Lr and Lm with the same voltage and current");
}

RecordBuilder fitted_response_record(const MotorEstimate& e, const MotorContext& c) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(e.omega.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return e.omega[a] < e.omega[b]; });
  order.erase(std::unique(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return e.omega[a] == e.omega[b]; }),
              order.end());
  const Band& first = c.bands.front();
  records::ResponseData d;
  d.form = c.settings.method == Method::maximum_likelihood ? "errors_in_variables" : method_name(c.settings.method);
  d.method = "frisch.motor";
  d.input_names = {first.input_name};
  d.output_names = {first.output_name};
  d.response_units = {records::ratio_unit(first.output_unit, first.input_unit)};
  d.frequency_hz = e.omega(order) / (2.0 * std::numbers::pi);
  const double delay = c.settings.sampling.delay_s;
  d.response =
      e.response(order).binaryExpr(e.omega(order), [delay](Complex g, double w) { return g * std::polar(1.0, -w * delay); });
  if (e.variance.size() > 0) {
    d.variance = e.variance(order);
    double degrees = 0.0;
    for (const Band& b : c.bands) degrees += static_cast<double>(b.mean.lines()) * b.degrees_of_freedom;
    if (degrees > 0.0) d.degrees_of_freedom = degrees;
  }
  return records::write_response(d);
}

}  // namespace bodeflow::frisch
