#include "band.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "records/record_arrays.hpp"
#include "records/response.hpp"
#include "records/signals.hpp"

namespace bodeflow::frisch {
namespace {

using Complex = std::complex<double>;
constexpr double kTurn = 2.0 * std::numbers::pi;

void set_units(Band& band, double scale) {
  MeanSpectra& m = band.mean;
  m.input *= scale;
  m.output *= scale;
  m.input_variance *= scale * scale;
  m.output_variance *= scale * scale;
  m.covariance *= scale * scale;
}

PowerSpectra products(const Band& band) {
  const double others = band.periods - 1.0;
  const MeanSpectra& m = band.mean;
  PowerSpectra p;
  p.uu = m.input.cwiseAbs2() + others * m.input_variance;
  p.yy = m.output.cwiseAbs2() + others * m.output_variance;
  p.yu = m.output.cwiseProduct(m.input.conjugate()) + others * m.covariance;
  return p;
}

/// Bartlett's statistic of one signal as a probability.
double flatness(const Eigen::VectorXd& variance, const Eigen::VectorXcd& mean, double degrees) {
  constexpr double kRounding = 1e-24;  // of the power: below it the scatter is that of the arithmetic
  const auto lines = static_cast<double>(variance.size());
  if (variance.size() < 2 || !(degrees > 0.0) || !(variance.minCoeff() > kRounding * mean.squaredNorm())) return 1.0;
  const double spread = std::log(variance.mean()) - variance.array().log().mean();
  const double correction = 1.0 + (lines + 1.0) / (6.0 * lines * degrees);
  return numerics::chi_squared_tail(2.0 * degrees * lines * spread / correction, lines - 1.0);
}

Expected<Eigen::MatrixXcd> complex_array(const RecordView& record, const char* name, Eigen::Index lines, Eigen::Index columns) {
  const auto array = record.array(name);
  if (!array) return refused("the record has no array '" + std::string(name) + "'");
  auto m = records::matrix_of<Complex>(*array, lines);
  if (!m) return refused(m.error().text);
  if (m->cols() != columns || static_cast<Eigen::Index>(array->size) != lines * columns) {
    return refused("array '" + std::string(name) + "' is " + records::shape_text(array->shape) +
                   "; needed: " + std::to_string(lines) + " x " + std::to_string(columns) + " values, one input and one output");
  }
  return *m;
}

}  // namespace

Eigen::VectorXd Band::frequency_hz() const { return mean.omega / kTurn; }

std::string Band::range() const {
  const Eigen::VectorXd f = frequency_hz();
  return records::short_number(f.minCoeff(), 3) + " to " + records::short_number(f.maxCoeff(), 3) + " Hz";
}

Expected<Band> band_of_response(const RecordView& record) {
  const auto read = records::read_response(record);
  if (!read) return refused(read.error().text);
  const records::ResponseData& r = *read;
  if (r.inputs() != 1 || r.outputs() != 1) {
    return refused("the response has " + records::counted(r.inputs(), "input") + " and " +
                   records::counted(r.outputs(), "output") + "; the motor at standstill has one of each");
  }
  Band b;
  b.input_name = r.input_names.front();
  b.output_name = r.output_names.front();
  b.sample_rate_hz = r.sample_rate_hz.value_or(0.0);
  b.period = r.period.value_or(0);
  const Eigen::Index lines = r.frequency_hz.size();
  b.mean.omega = kTurn * r.frequency_hz;
  if (!r.spectra) {
    if (r.variance.size() == 0) {
      return refused(
          "the response has neither mean spectra nor a variance; measure it by spectrum.averaging_dft over 2 periods or more");
    }
    b.mean.input = Eigen::VectorXcd::Ones(lines);
    b.mean.output = r.response.col(0);
    b.mean.input_variance = Eigen::VectorXd::Zero(lines);
    b.mean.output_variance = r.variance.col(0);
    b.mean.covariance = Eigen::VectorXcd::Zero(lines);
    return b;
  }
  if (!r.period || !r.periods) return refused("the response has mean spectra, but not its 'period' and 'periods'");
  b.mean.input = r.spectra->input;
  b.mean.output = r.spectra->output;
  b.mean.input_variance = r.spectra->input_variance;
  b.mean.output_variance = r.spectra->output_variance;
  b.mean.covariance = r.spectra->covariance;
  b.input_unit = record.array("input_mean")->unit;
  b.output_unit = record.array("output_mean")->unit;
  b.periods = b.windows = static_cast<double>(*r.periods);
  b.degrees_of_freedom = r.degrees_of_freedom.value_or(b.periods - 1.0);
  set_units(b, std::sqrt(static_cast<double>(*r.period)));
  if (b.has_scatter()) b.power = products(b);
  return b;
}

Expected<Band> band_of_matrix(const RecordView& record) {
  if (record.type() != "spectral_matrix") {
    return refused("a record of type '" + std::string(record.type()) + "'; needed: spectral_matrix");
  }
  const auto frequency = records::list_of<double>(record, "frequency");
  if (!frequency) return refused(frequency.error().text);
  const auto period = record.integer("period"), windows = record.integer("windows"),
             periods = record.integer("synchronous_windows");
  if (!period || !windows || !periods) {
    return refused("the record lacks 'period', 'windows' or 'synchronous_windows'");
  }
  const Eigen::Index lines = frequency->size();
  auto matrix = complex_array(record, "matrix", lines, 4);
  if (!matrix) return tl::make_unexpected(matrix.error());
  auto mean = complex_array(record, "mean", lines, 2);
  if (!mean) return tl::make_unexpected(mean.error());
  Eigen::MatrixXcd noise = Eigen::MatrixXcd::Zero(lines, 4);
  Band b;
  b.windows = static_cast<double>(*windows);
  if (record.array("noise_covariance")) {
    auto covariance = complex_array(record, "noise_covariance", lines, 4);
    if (!covariance) return tl::make_unexpected(covariance.error());
    b.periods = static_cast<double>(*periods);
    b.degrees_of_freedom = b.periods - 1.0;
    noise = *covariance / b.periods;
  }
  b.sample_rate_hz = record.number("sample_rate").value_or(0.0);
  b.period = *period;
  const auto scale = static_cast<double>(*period);
  b.power.uu = scale * matrix->col(0).real();
  b.power.yy = scale * matrix->col(3).real();
  b.power.yu = scale * matrix->col(2);
  b.mean = {kTurn * *frequency, mean->col(0), mean->col(1), noise.col(0).real(), noise.col(3).real(), noise.col(2)};
  set_units(b, std::sqrt(scale));
  if (const auto names = record.texts("signal_names"); names && names->size() == 2) {
    b.input_name = (*names)[0];
    b.output_name = (*names)[1];
  }
  if (const auto units = record.texts("signal_units"); units && units->size() == 2) {
    b.input_unit = (*units)[0];
    b.output_unit = (*units)[1];
  }
  return b;
}

Expected<Band> band_of_samples(const Eigen::VectorXd& input, const Eigen::VectorXd& output, Eigen::Index period,
                               Eigen::Index step, const std::vector<Eigen::Index>& lines, double sample_rate_hz) {
  if (period < 1 || input.size() < 2 * period) {
    return refused(std::to_string(input.size()) + " samples; needed: at least 2 periods of " + std::to_string(period));
  }
  Band b;
  b.period = period;
  b.sample_rate_hz = sample_rate_hz;
  Eigen::VectorXd omega(static_cast<Eigen::Index>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    omega[static_cast<Eigen::Index>(i)] = kTurn * static_cast<double>(lines[i]) * sample_rate_hz / static_cast<double>(period);
  }
  auto u = window_spectra(input, period, period, lines), y = window_spectra(output, period, period, lines);
  if (!u) return refused("input: " + u.error().text);
  if (!y) return refused("output: " + y.error().text);
  const auto mean = mean_spectra(omega, *u, *y, PooledNoise{});
  if (!mean) return tl::make_unexpected(mean.error());
  b.mean = *mean;
  b.periods = static_cast<double>(u->cols());
  b.degrees_of_freedom = b.periods - 1.0;
  const double of_mean = 1.0 / (b.periods * b.degrees_of_freedom);
  const Eigen::MatrixXcd du = u->colwise() - b.mean.input, dy = y->colwise() - b.mean.output;
  b.mean.input_variance = of_mean * du.rowwise().squaredNorm();
  b.mean.output_variance = of_mean * dy.rowwise().squaredNorm();
  b.mean.covariance = of_mean * dy.cwiseProduct(du.conjugate()).rowwise().sum();
  if (step != period) {
    u = window_spectra(input, period, step, lines);
    y = window_spectra(output, period, step, lines);
    if (!u) return tl::make_unexpected(u.error());
    if (!y) return tl::make_unexpected(y.error());
  }
  b.windows = static_cast<double>(u->cols());
  const auto power = power_spectra(*u, *y);
  if (!power) return tl::make_unexpected(power.error());
  b.power = *power;
  return b;
}

Expected<Band> part_of(const Band& band, double low_rad_s, double high_rad_s) {
  std::vector<Eigen::Index> kept;
  // An end that was meant to be on a line stays on it after conversion of units.
  constexpr double kSlack = 1e-9;
  for (Eigen::Index k = 0; k < band.mean.lines(); ++k) {
    const double w = band.mean.omega[k];
    if (w >= low_rad_s * (1.0 - kSlack) && w <= high_rad_s * (1.0 + kSlack)) kept.push_back(k);
  }
  if (kept.empty()) {
    return refused("the band " + records::short_number(low_rad_s / kTurn) + " to " + records::short_number(high_rad_s / kTurn) +
                   " Hz holds none of the lines from " + band.range());
  }
  Band part = band;
  const auto keep = [&](auto& values) {
    if (values.size() > 0) values = values(kept).eval();
  };
  MeanSpectra& m = part.mean;
  keep(m.omega), keep(m.input), keep(m.output), keep(m.input_variance), keep(m.output_variance), keep(m.covariance);
  keep(part.power.uu), keep(part.power.yy), keep(part.power.yu);
  return part;
}

PooledNoise pooled_noise(const Band& band) {
  const MeanSpectra& m = band.mean;
  PooledNoise noise;
  noise.degrees_of_freedom = static_cast<double>(m.lines()) * band.degrees_of_freedom;
  noise.input_variance = band.periods * m.input_variance.mean();
  noise.output_variance = band.periods * m.output_variance.mean();
  noise.covariance = band.periods * m.covariance.mean();
  return noise;
}

MeanSpectra with_pooled_noise(const Band& band, bool correlated) {
  MeanSpectra m = band.mean;
  if (band.has_scatter()) {
    m.input_variance.setConstant(m.input_variance.mean());
    m.output_variance.setConstant(m.output_variance.mean());
    m.covariance.setConstant(m.covariance.mean());
  }
  if (!correlated) m.covariance.setZero();
  return m;
}

double noise_flatness(const Band& band) {
  if (!band.has_scatter()) return 1.0;
  const double input = flatness(band.mean.input_variance, band.mean.input, band.degrees_of_freedom),
               output = flatness(band.mean.output_variance, band.mean.output, band.degrees_of_freedom);
  return std::min(1.0, 2.0 * std::min(input, output));
}

}  // namespace bodeflow::frisch
