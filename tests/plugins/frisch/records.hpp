#pragma once

#include <bodeflow/record.hpp>
#include <complex>
#include <vector>

#include "frisch/windows.hpp"
#include "motor.hpp"
#include "plugins/spectrum/record_bytes.hpp"
#include "spectrum/averaging_dft.hpp"
#include "spectrum/response_record.hpp"
#include "spectrum/spectral_matrix.hpp"

/// Records of a band, as the blocks of the spectrum family make them.
namespace bodeflow::test {

inline std::vector<std::int64_t> line_numbers(const MotorBand& band) { return {band.lines.begin(), band.lines.end()}; }

inline Rate rate_of(const MotorBand& band) { return Rate::from_hz(1.0 / band.sample_time); }

inline RecordBuilder response_record(const MotorRecord& r, const MotorBand& band) {
  spectrum::AveragingDft dft(128, 1);
  for (Eigen::Index n = 0; n + 128 <= r.voltage.size(); n += 128) dft.add(r.voltage.segment(n, 128), r.current.segment(n, 128));
  const auto moments = dft.moments();
  const spectrum::LineChoice lines{line_numbers(band), 0.0};
  const spectrum::Measured measured{{1, 1, 0}, 128, 1, {*moments}};
  const auto estimate = dft.estimate(lines, spectrum::Form::errors_in_variables);
  spectrum::Measurement from;
  from.layout = {1, 1, 0};
  from.rate = rate_of(band);
  from.period = 128;
  from.names = {"voltage", "current"};
  from.units = {"V", "A"};
  return spectrum::response_record(*estimate,
                                   spectrum::levels_of(measured, estimate->lines, band.lines.front(), band.lines.back()), from);
}

/// The record `spectral_matrix` of windows `step` apart.
inline RecordBuilder matrix_record(const MotorRecord& r, const MotorBand& band, Eigen::Index step) {
  using Complex = std::complex<double>;
  const auto count = static_cast<std::uint64_t>(band.lines.size());
  const WindowSpectra overlapping = windows(r, band, step), whole = windows(r, band, 128);
  const auto power = *frisch::power_spectra(overlapping.input, overlapping.output);
  const auto periods = static_cast<double>(whole.input.cols());
  RecordBuilder record("spectral_matrix");
  record.set("signal_names", std::vector<std::string>{"voltage", "current"});
  record.set("signal_units", std::vector<std::string>{"V", "A"});
  record.set("windows", static_cast<std::int64_t>(overlapping.input.cols()));
  record.set("synchronous_windows", static_cast<std::int64_t>(whole.input.cols()));
  record.set("sample_rate", 1.0 / band.sample_time);
  record.set("period", std::int64_t{128});
  const Eigen::VectorXd omega = band.omega();
  const auto frequency = record.array<double>("frequency", "Hz", {count});
  for (std::uint64_t k = 0; k < count; ++k) frequency[k] = omega[static_cast<Eigen::Index>(k)] / (2.0 * std::numbers::pi);
  const auto put = [&](const char* name, auto entries) {
    const auto data = record.array<Complex>(name, "", {count, 2, 2});
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::array<Complex, 4> four = entries(static_cast<Eigen::Index>(k));
      for (std::uint64_t i = 0; i < 4; ++i) data[4 * k + i] = four[i] / 128.0;
    }
  };
  put("matrix", [&](Eigen::Index k) {
    return std::array<Complex, 4>{power.uu[k], std::conj(power.yu[k]), power.yu[k], power.yy[k]};
  });
  put("noise_covariance", [&](Eigen::Index k) {
    const Eigen::RowVectorXcd u = whole.input.row(k).array() - whole.input.row(k).mean(),
                              y = whole.output.row(k).array() - whole.output.row(k).mean();
    const Complex yu = y.dot(u) / (periods - 1.0);  // conj(y) u
    return std::array<Complex, 4>{u.squaredNorm() / (periods - 1.0), yu, std::conj(yu), y.squaredNorm() / (periods - 1.0)};
  });
  const auto mean = record.array<Complex>("mean", "", {count, 2});
  for (std::uint64_t k = 0; k < count; ++k) {
    mean[2 * k] = whole.input.row(static_cast<Eigen::Index>(k)).mean() / std::sqrt(128.0);
    mean[2 * k + 1] = whole.output.row(static_cast<Eigen::Index>(k)).mean() / std::sqrt(128.0);
  }
  return record;
}

}  // namespace bodeflow::test
