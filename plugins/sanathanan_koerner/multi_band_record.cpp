#include "multi_band_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model_record.hpp"
#include "records/model.hpp"
#include "records/record_arrays.hpp"
#include "records/response_units.hpp"
#include "records/signals.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

const double kHz = 1.0 / (2.0 * std::numbers::pi);

}  // namespace

Expected<RecordBuilder> multi_band_record(const MultiBandFit& fit, const Measured& measured,
                                          const std::vector<std::string>& warnings) {
  const auto system = state_space(fit);
  if (!system) return unexpected(system.error().text);
  records::ModelData m;
  m.method = "sanathanan_koerner.multi_band";
  m.form = "state_space";
  m.state_space = reshaped(*system, static_cast<Eigen::Index>(measured.inputs.names.size()));
  const auto count = static_cast<Eigen::Index>(fit.bands.size());
  Eigen::MatrixXd edges(count, 2);
  Eigen::VectorXd orders(count), prewarps(count);
  m.poles.resize(system->states());
  for (Eigen::Index b = 0; b < count; ++b) {
    const BandModel& band = fit.bands[static_cast<std::size_t>(b)];
    edges.row(b) << kHz * band.low_rad_s, kHz * band.high_rad_s;
    orders[b] = static_cast<double>(band.order);
    prewarps[b] = band.prewarp_rad_s;
    m.poles.segment(m.order, band.order) = band.fit.poles;
    m.order += band.order;
  }
  m.input_name = measured.inputs.names.front();
  m.output_name = measured.outputs.names.front();
  if (measured.inputs.names.size() > 1) m.inputs = measured.inputs;
  if (measured.outputs.names.size() > 1) m.outputs = measured.outputs;
  m.warnings = warnings;
  m.conventions = {"a sum of models, one a band, each with its own poles"};
  if (measured.sample_time_s > 0.0) m.sample_rate_hz = 1.0 / measured.sample_time_s;
  m.samples = measured.data.lines();
  m.band_hz = kHz * Eigen::Vector2d(measured.data.omega_rad_s[0], measured.data.omega_rad_s[measured.data.lines() - 1]);
  m.data_checksum = measured.checksum;
  RecordBuilder r = records::write_model(m);
  const Eigen::MatrixXd error = (measured.data.response - fit.response).cwiseAbs();
  r.set("relative_error", fit.error);
  r.set("one_band_error", fit.one_band_error);
  r.set("one_band_order", static_cast<std::int64_t>(fit.one_band_order));
  r.set("rms_error", error.norm() / std::sqrt(static_cast<double>(error.size())));
  r.set("max_error", error.maxCoeff());
  r.set("reason", fit.reason);
  records::put_matrix(r, "band_edges", "Hz", edges);
  records::put_list<double>(r, "band_order", "1", orders);
  records::put_list<double>(r, "band_prewarp", "rad/s", prewarps);
  return r;
}

RecordBuilder band_residual_record(const MultiBandFit& fit, const Measured& measured) {
  RecordBuilder r = residual_record(measured, fit.response, "sanathanan_koerner.multi_band");
  const auto count = static_cast<Eigen::Index>(fit.bands.size()), lines = measured.data.lines();
  Eigen::MatrixXd edges(count, 2);
  Eigen::MatrixXcd models(count * lines, measured.data.channels());
  for (Eigen::Index b = 0; b < count; ++b) {
    const BandModel& band = fit.bands[static_cast<std::size_t>(b)];
    edges.row(b) << kHz * band.low_rad_s, kHz * band.high_rad_s;
    models.middleRows(b * lines, lines) = band.fit.response;
  }
  records::put_matrix(r, "band_edges", "Hz", edges);
  const auto shape = std::array{static_cast<std::uint64_t>(count), static_cast<std::uint64_t>(lines),
                                static_cast<std::uint64_t>(measured.data.channels())};
  records::put<std::complex<double>>(r, "band_response", records::common_unit(measured.units), shape, models);
  return r;
}

RecordBuilder band_log_record(const MultiBandFit& fit) {
  std::size_t bands = 0;
  for (const Round& round : fit.log) bands = std::max(bands, round.iterations.size());
  const auto rounds = static_cast<Eigen::Index>(fit.log.size());
  Eigen::MatrixXd iterations = Eigen::MatrixXd::Zero(rounds, static_cast<Eigen::Index>(bands));
  Eigen::VectorXd error(rounds);
  std::vector<std::string> phases;
  for (Eigen::Index n = 0; n < rounds; ++n) {
    const Round& round = fit.log[static_cast<std::size_t>(n)];
    phases.push_back(round.phase);
    error[n] = round.error;
    for (std::size_t b = 0; b < round.iterations.size(); ++b) iterations(n, static_cast<Eigen::Index>(b)) = round.iterations[b];
  }
  RecordBuilder r("band_log");
  r.set("phases", phases);
  r.set("reason", fit.reason);
  records::put_matrix(r, "iterations", "1", iterations);
  records::put_list<double>(r, "error", "1", error);
  return r;
}

std::vector<std::string> multi_band_warnings(const MultiBandFit& fit, const MultiBandSettings& settings) {
  std::vector<std::string> warnings;
  const std::string one = "one band with " + std::to_string(fit.one_band_order) + " poles has the error " +
                          records::short_number(fit.one_band_error, 3);
  if (settings.cuts_rad_s.empty() && fit.bands.size() == 1) {
    warnings.push_back("no division into bands is better than one band, which is the model: " + one);
  } else if (fit.error > fit.one_band_error) {
    warnings.push_back(one + ", less than these bands, " + records::short_number(fit.error, 3) +
                       ": take sanathanan_koerner.model");
  }
  return warnings;
}

}  // namespace bodeflow::sanathanan_koerner
