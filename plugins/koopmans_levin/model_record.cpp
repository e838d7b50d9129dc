#include "model_record.hpp"

#include <algorithm>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "poles.hpp"
#include "records/model.hpp"
#include "records/record_arrays.hpp"
#include "records/response_units.hpp"

namespace bodeflow::koopmans_levin {

namespace {

using Complex = std::complex<double>;

/// By frequency, of a pair the root above the axis first.
bool before(Complex a, Complex b) {
  const double of_a = std::abs(std::log(a)), of_b = std::abs(std::log(b));
  constexpr double kSame = 1e-12;
  if (std::abs(of_a - of_b) > kSame * (of_a + of_b)) return of_a < of_b;
  return a.imag() > b.imag();
}

bool finite(const std::vector<Eigen::Matrix2d>& all) {
  return std::all_of(all.begin(), all.end(), [](const Eigen::Matrix2d& m) { return m.allFinite(); });
}

/// Zeros with their covariance where it is known and finite.
Expected<void> add_zeros(const Identification& found, records::ModelData& m) {
  const Eigen::Index powers = found.model.b.size();
  if (found.model.b.isZero(0.0)) return {};
  auto zeros = numerics::roots(found.model.b);
  if (!zeros) return tl::make_unexpected(zeros.error());
  std::sort(zeros->begin(), zeros->end(), before);
  m.zeros = *zeros;
  if (found.covariance.size() == 0) return {};
  auto spread = root_covariance(found.model.b, found.covariance.bottomRightCorner(powers, powers), *zeros);
  if (finite(spread)) m.zero_covariance = std::move(spread);
  return {};
}

void add_poles(const std::vector<Pole>& poles, bool certain, records::ModelData& m) {
  m.poles.resize(static_cast<Eigen::Index>(poles.size()));
  std::vector<Eigen::Matrix2d> spread;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    m.poles[static_cast<Eigen::Index>(i)] = poles[i].z;
    spread.push_back(poles[i].z_covariance);
  }
  if (certain && finite(spread)) m.pole_covariance = std::move(spread);
}

records::ModelData described(const Identification& found, const Origin& from) {
  const Model& model = found.model;
  records::ModelData m;
  m.method = "koopmans_levin.model";
  m.form = "transfer_function";
  m.order = model.order();
  m.sample_time_s = 1.0 / from.sample_rate_hz;
  m.parameter_names = parameter_names(model.order());
  m.input_name = from.input.names[0];
  m.output_name = from.output.names[0];
  m.input_unit = from.input.units[0];
  m.output_unit = from.output.units[0];
  m.parameter_units.assign(static_cast<std::size_t>(model.order()), "1");
  m.parameter_units.resize(m.parameter_names.size(), records::ratio_unit(m.output_unit, m.input_unit));
  m.parameters = parameters(model);
  m.covariance = found.covariance;
  m.numerator = model.b;
  m.denominator = model.a;
  m.conventions = {"sampled signals: the hold and delay of the sampling are part of the model"};
  m.warnings = from.warnings;
  m.noise_ratio = model.ratio;
  m.input_noise_variance = model.noise_unbiased;
  m.output_noise_variance = model.ratio * model.noise_unbiased;
  m.sample_rate_hz = from.sample_rate_hz;
  m.samples = found.lines.samples;
  m.input_amplitude = from.input_amplitude;
  const double hz_per_rad = from.sample_rate_hz / (2.0 * std::numbers::pi);
  m.band_hz = hz_per_rad * Eigen::Vector2d(found.lines.omega(0), found.lines.omega(found.lines.size() - 1));
  m.data_checksum = from.checksum;
  return m;
}

void add_noise(const Identification& found, RecordBuilder& r) {
  r.set("ratio_determined", found.ratio_source != RatioSource::fallback);
  r.set("ratio_source", name_of(found.ratio_source));
  if (found.estimate && found.estimate->determined) {
    r.set("noise_ratio_std", found.estimate->ratio * found.estimate->log_ratio_std);
    if (found.estimate->lags > 0) r.set("covariance_matching_lags", found.estimate->lags);
  }
  if (std::isfinite(found.noise_std) && found.covariance.size() > 0) r.set("input_noise_variance_std", found.noise_std);
  r.set("smallest_eigenvalue", found.model.noise);
  if (found.whiteness) r.set("whiteness_probability", found.whiteness->probability);
}

}  // namespace

Expected<RecordBuilder> model_record(const Identification& found, const Origin& from) {
  const Eigen::Index n = found.model.order();
  const bool certain = found.covariance.size() > 0;
  const Eigen::MatrixXd covariance = certain ? found.covariance : Eigen::MatrixXd::Zero(n, n);
  auto poles = koopmans_levin::poles(found.model, covariance, 1.0 / from.sample_rate_hz);
  if (!poles) return tl::make_unexpected(poles.error());
  std::sort(poles->begin(), poles->end(), [](const Pole& a, const Pole& b) { return before(a.z, b.z); });
  records::ModelData m = described(found, from);
  add_poles(*poles, certain, m);
  if (auto done = add_zeros(found, m); !done) return tl::make_unexpected(done.error());
  RecordBuilder r = records::write_model(m);
  add_noise(found, r);
  Eigen::VectorXd frequency(n), deviation(n), damping(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Pole& p = (*poles)[static_cast<std::size_t>(i)];
    frequency[i] = p.frequency_hz;
    deviation[i] = p.frequency_std_hz;
    damping[i] = p.damping_ratio;
  }
  records::put_list<double>(r, "pole_frequency", "Hz", frequency);
  if (!m.pole_covariance.empty()) records::put_list<double>(r, "pole_frequency_std", "Hz", deviation);
  records::put_list<double>(r, "pole_damping_ratio", "1", damping);
  if (found.model.tau.size() > 0) records::put_list<double>(r, "transient", m.output_unit, found.model.tau);
  if (found.sensitivity) records::put_list<double>(r, "ratio_shift_in_std", "1", found.sensitivity->shift_in_std);
  return r;
}

RecordBuilder order_scan_record(const OrderScan& scan) {
  const auto size = static_cast<Eigen::Index>(scan.orders.size());
  Eigen::VectorXd order(size), noise(size), ratio(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ScannedOrder& one = scan.orders[static_cast<std::size_t>(i)];
    order[i] = static_cast<double>(one.order);
    noise[i] = one.noise;
    ratio[i] = one.ratio;
  }
  RecordBuilder r("order_scan");
  r.set("chosen", scan.chosen);
  r.set("tolerance", scan.tolerance);
  records::put_list<double>(r, "order", "1", order);
  records::put_list<double>(r, "noise_variance", "", noise);
  records::put_list<double>(r, "eigenvalue_ratio", "1", ratio);
  return r;
}

RecordBuilder whiteness_record(const Whiteness& test, double sample_rate_hz) {
  RecordBuilder r("whiteness");
  r.set("statistic", test.statistic);
  r.set("degrees_of_freedom", test.degrees_of_freedom);
  r.set("probability", test.probability);
  records::put_list<double>(r, "frequency", "Hz", test.band_omega * (sample_rate_hz / (2.0 * std::numbers::pi)));
  records::put_list<double>(r, "power", "1", test.band_mean);
  return r;
}

}  // namespace bodeflow::koopmans_levin
