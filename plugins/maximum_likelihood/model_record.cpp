#include "model_record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "records/model.hpp"
#include "records/record_arrays.hpp"
#include "records/response_units.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kEdge = 1e-9;  // relative rounding at the edge of a band

std::string weighting_name(Weighting weighting) {
  if (weighting == Weighting::variance) return "variance";
  return weighting == Weighting::even ? "none" : "relative";
}

// Unit of a coefficient, power of s or z: a_p goes with (rad/s)^(n - p), b_p likewise with the unit of the response before it.
std::string coefficient_unit(const std::string& name, const Structure& structure, const std::string& response_unit) {
  if (name == "delay") return "s";
  const bool numerator = name.front() == 'b';
  const Eigen::Index power = structure.order - std::stol(name.substr(1));
  const bool bare = structure.domain == Domain::z || power == 0;
  const std::string of_s = bare ? "" : power == 1 ? "rad/s" : "(rad/s)^" + std::to_string(power);
  if (!numerator || response_unit.empty() || response_unit == "1") return of_s.empty() ? "1" : of_s;
  return of_s.empty() ? response_unit : response_unit + " " + of_s;
}

std::vector<Eigen::Matrix2d> covariances(const Eigen::MatrixXcd& slopes, const Eigen::MatrixXd& root) {
  std::vector<Eigen::Matrix2d> all;
  for (Eigen::Index i = 0; i < slopes.rows() && root.size() != 0; ++i) {
    all.push_back(root_covariance(slopes.row(i), root));
    if (!all.back().allFinite()) return {};
  }
  return all;
}

void add_roots(const Identification& id, records::ModelData& m) {
  const Rational& model = id.fit.models.front();
  const Estimate& estimate = id.fit.minimum.estimate;
  m.poles = model.poles;
  m.zeros = model.zeros;
  m.pole_covariance = covariances(pole_slopes(id.fit.lines, id.fit.structure, estimate, model), id.covariance_root);
  m.zero_covariance = covariances(zero_slopes(id.fit.lines, estimate, 0, model), id.covariance_root);
}

void add_tests(const Identification& id, records::ModelData& m) {
  m.aic = id.criteria.aic;
  m.mdl = id.criteria.mdl;
  if (!id.variance_known) return;
  m.cost = id.test.cost;
  if (std::isfinite(id.test.expected)) m.expected_cost = id.test.expected;
  m.cost_degrees_of_freedom = id.test.degrees_of_freedom;
}

std::vector<std::string> conventions_of(const Identification& id, const Measured& measured) {
  std::vector<std::string> texts;
  if (id.fit.structure.zero_order_hold) {
    texts.push_back("continuous in time; fitted through its exact equivalent for an input held between the samples");
  } else if (id.fit.structure.domain == Domain::z) {
    texts.push_back("sampled signals: hold and delay of the sampling are part of the model");
  } else {
    texts.push_back("continuous in time; a hold of the input, where there is one, is part of the model");
  }
  if (id.fit.models.size() > 1) {
    std::string outputs;
    for (const std::string& name : measured.output_names) outputs += (outputs.empty() ? "'" : ", '") + name + "'";
    texts.push_back("one denominator and delay for " + outputs);
  }
  return texts;
}

records::ModelData described(const Identification& id, const Measured& measured, const std::vector<std::string>& warnings) {
  const Fit& fit = id.fit;
  const Coefficients c =
      coefficients_of(fit.lines, fit.structure, fit.minimum.estimate, 0, fit.models.front(), id.covariance_root);
  records::ModelData m;
  m.method = "maximum_likelihood.model";
  m.form = "transfer_function";
  m.order = fit.structure.order;
  m.sample_time_s = fit.models.front().sample_time_s;
  m.delay_s = fit.models.front().delay_s;
  m.parameter_names = c.names;
  for (const std::string& name : c.names)
    m.parameter_units.push_back(coefficient_unit(name, fit.structure, measured.units.front()));
  m.parameters = c.values;
  if (c.covariance.allFinite()) m.covariance = c.covariance;
  m.numerator = fit.models.front().numerator();
  m.denominator = fit.models.front().denominator();
  add_roots(id, m);
  m.input_name = measured.input_name;
  m.output_name = measured.output_names.front();
  m.input_unit = measured.input_unit;
  m.output_unit = measured.output_unit;
  m.conventions = conventions_of(id, measured);
  m.warnings = warnings;
  add_tests(id, m);
  if (id.spectra.sample_time_s > 0.0) m.sample_rate_hz = 1.0 / id.spectra.sample_time_s;
  m.samples = id.spectra.lines();
  const double hz = 1.0 / (2.0 * std::numbers::pi);
  m.band_hz = hz * Eigen::Vector2d(id.spectra.omega_rad_s[0], id.spectra.omega_rad_s[id.spectra.lines() - 1]);
  m.input_amplitude = measured.input_amplitude;
  m.data_checksum = measured.checksum;
  return m;
}

void add_evidence(const Identification& id, RecordBuilder& r) {
  const std::vector<Attempt>& attempts = id.fit.attempts;
  std::vector<std::string> names;
  Eigen::VectorXd before(static_cast<Eigen::Index>(attempts.size())), after = before, delay = before;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    names.push_back(attempts[i].start);
    before[at] = attempts[i].start_cost;
    after[at] = attempts[i].cost;
    delay[at] = attempts[i].delay_s;
  }
  r.set("converged", id.fit.minimum.converged);
  r.set("reason", id.fit.minimum.reason);
  r.set("starts", names);
  r.set("starts_at_least_cost", static_cast<std::int64_t>(id.fit.reached));
  records::put_list<double>(r, "start_cost", "1", before);
  records::put_list<double>(r, "searched_cost", "1", after);
  records::put_list<double>(r, "start_delay", "s", delay);
}

// First and last line of each band.
std::vector<std::pair<Eigen::Index, Eigen::Index>> bands_of(const Eigen::VectorXd& frequency, const std::vector<double>& edges) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> bands;
  const Eigen::Index lines = frequency.size();
  if (edges.size() < 2) {
    const Eigen::Index count = std::clamp<Eigen::Index>(lines / 5, 1, 6);
    for (Eigen::Index b = 0; b < count; ++b) bands.push_back({b * lines / count, (b + 1) * lines / count - 1});
    return bands;
  }
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    const bool last = b + 2 == edges.size();
    Eigen::Index first = 0, end = 0;
    const double from = edges[b] * (1.0 - kEdge), to = edges[b + 1] * (last ? 1.0 + kEdge : 1.0 - kEdge);
    while (first < lines && frequency[first] < from) ++first;
    end = first;
    while (end < lines && frequency[end] < to) ++end;
    if (end > first) bands.push_back({first, end - 1});
  }
  return bands;
}

}  // namespace

RecordBuilder model_record(const Identification& id, const Measured& measured, const Settings& settings,
                           const std::vector<std::string>& warnings) {
  const records::ModelData m = described(id, measured, warnings);
  RecordBuilder r = records::write_model(m);
  r.set("domain", settings.domain == Domain::s ? "s" : "z");
  r.set("hold", settings.zero_order_hold ? "zero_order" : "none");
  r.set("weighting", weighting_name(settings.weighting));
  r.set("fitted_outputs", measured.output_names);
  if (m.covariance.size() != 0) {
    r.set("covariance_method", id.covariance_kind == CovarianceKind::information ? "inverse Fisher information"
                               : id.fit.correlation.any()                        ? "residuals (sandwich), lines correlated"
                                                                                 : "residuals (sandwich)");
    records::put_list<double>(r, "standard_deviation", "", m.covariance.diagonal().cwiseSqrt());
    if (id.fit.structure.estimate_delay)
      r.set("delay_std", std::sqrt(m.covariance(m.covariance.rows() - 1, m.covariance.rows() - 1)));
  }
  if (id.variance_known) {
    if (id.test.deviation) r.set("cost_deviation", *id.test.deviation);
    if (id.test.probability) r.set("cost_probability", *id.test.probability);
    if (std::isfinite(id.spectra.degrees_of_freedom)) r.set("variance_degrees_of_freedom", id.spectra.degrees_of_freedom);
  }
  if (const auto& white = id.whiteness.front()) {
    r.set("whiteness_statistic", white->statistic);
    r.set("whiteness_lags", static_cast<std::int64_t>(white->lags));
    r.set("whiteness_probability", white->probability);
  }
  if (id.fit.correlation.any())
    r.set("effective_lines", static_cast<double>(id.spectra.lines()) / id.fit.correlation.lines_of_one());
  add_evidence(id, r);
  return r;
}

RecordBuilder order_scan_record(const OrderScan& scan) {
  const auto size = static_cast<Eigen::Index>(scan.orders.size());
  Eigen::MatrixXd columns(size, 8);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ScannedOrder& one = scan.orders[static_cast<std::size_t>(i)];
    columns.row(i) << static_cast<double>(one.fit.structure.order), static_cast<double>(one.fit.parameters()), one.test.cost,
        one.test.expected, one.test.probability.value_or(NAN), one.criteria.aic, one.criteria.mdl, one.significance;
  }
  RecordBuilder r("order_scan");
  r.set("chosen", scan.orders[scan.chosen].fit.structure.order);
  r.set("rule", "the lowest order whose cost no higher one undercuts significantly (1 %, for all lines)");
  const char* names[] = {"order", "parameter_count", "cost", "expected_cost", "cost_probability", "aic", "mdl", "significance"};
  for (Eigen::Index c = 0; c < columns.cols(); ++c) records::put_list<double>(r, names[c], "1", columns.col(c));
  return r;
}

RecordBuilder residual_record(const Identification& id, const Measured& measured, const Spectra& spectra,
                              const std::vector<double>& edges_hz) {
  const Eigen::MatrixXcd response = spectra.response(), error = response - id.fit.response;
  const Eigen::MatrixXd relative = error.cwiseAbs().cwiseQuotient(response.cwiseAbs());
  const Eigen::VectorXd frequency = spectra.omega_rad_s / (2.0 * std::numbers::pi);
  const Eigen::MatrixXd deviation =
      spectra.input.cwiseAbs().cwiseInverse().asDiagonal() * spectra.error_variance(id.fit.response).cwiseSqrt();
  const bool certain = measured.has_variance && deviation.minCoeff() > 0.0;
  Eigen::MatrixXcd normalised;
  if (certain) normalised = error.cwiseQuotient(deviation.cast<std::complex<double>>());

  const auto bands = bands_of(frequency, edges_hz);
  const auto count = static_cast<Eigen::Index>(bands.size());
  Eigen::MatrixXd limits(count, 2), band_error(count, error.cols()), band_residual(count, error.cols());
  for (Eigen::Index b = 0; b < count; ++b) {
    const auto [first, last] = bands[static_cast<std::size_t>(b)];
    const Eigen::Index size = last - first + 1;
    limits.row(b) << frequency[first], frequency[last];
    band_error.row(b) = (relative.middleRows(first, size).colwise().squaredNorm() / static_cast<double>(size)).cwiseSqrt();
    if (certain)
      band_residual.row(b) = (normalised.middleRows(first, size).colwise().squaredNorm() / static_cast<double>(size)).cwiseSqrt();
  }

  RecordBuilder r("residual");
  r.set("method", "maximum_likelihood.model");
  r.set("output_names", measured.output_names);
  r.set("input_name", measured.input_name);
  const auto shape =
      std::vector<std::uint64_t>{static_cast<std::uint64_t>(error.rows()), static_cast<std::uint64_t>(error.cols())};
  const std::string unit = records::common_unit(measured.units);
  records::put_list<double>(r, "frequency", "Hz", frequency);
  records::put<std::complex<double>>(r, "response", unit, shape, response);
  records::put<std::complex<double>>(r, "model_response", unit, shape, id.fit.response);
  records::put_matrix(r, "relative_error", "1", relative);
  if (certain) records::put<std::complex<double>>(r, "residual", "1", shape, normalised);
  records::put_matrix(r, "band", "Hz", limits);
  records::put_matrix(r, "band_relative_error", "1", band_error);
  if (certain) records::put_matrix(r, "band_residual", "1", band_residual);
  return r;
}

}  // namespace bodeflow::maximum_likelihood
