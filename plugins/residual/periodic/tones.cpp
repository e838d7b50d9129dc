#include "periodic/tones.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>

#include "periodic/leakage.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// A tone that shows between the lines by less than this part of its size stands on a line.
constexpr double kOnLine = 0.02;

Eigen::VectorXcd bins_of_tone(const PeriodicRecord& r, double frequency_hz, Complex amplitude) {
  const double samples = static_cast<double>(r.period * r.periods), f = frequency_hz / r.sample_rate_hz;
  Eigen::VectorXcd bins(r.bins());
  for (Eigen::Index l = 0; l < r.bins(); ++l) {
    const double at = static_cast<double>(l) / samples;
    bins[l] = 0.5 * (amplitude * leaked(f - at, samples) + std::conj(amplitude) * leaked(-f - at, samples));
  }
  return bins;
}

/// The rows of bins between the lines, the others set to zero.
Eigen::MatrixXd between(const PeriodicRecord& r, Eigen::MatrixXd rows) {
  for (Eigen::Index k = 0; k < r.lines(); ++k) {
    const BinRows line = rows_of(k * r.periods);
    rows.middleRows(line.begin, line.count).setZero();
  }
  return rows;
}

}  // namespace

Tones::Tones(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values) : record_(record) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t a = 0; a < model.additions.size(); ++a) {
    if (model.additions[a].what.acts != Acts::tone) continue;
    for (const double f : model.additions[a].effect->tones_hz(model.values_of(a, values))) {
      if (!(f > 0.0) || f > record.frequency_hz[record.bins() - 1]) continue;
      const Eigen::VectorXd cosine = whitened(record, bins_of_tone(record, f, 1.0));
      const Eigen::VectorXd sine = whitened(record, bins_of_tone(record, f, Complex(0.0, -1.0)));
      if (between(record, cosine).norm() < kOnLine * cosine.norm()) continue;
      columns.push_back(cosine);
      columns.push_back(sine);
    }
  }
  columns_.resize(2 * record.bins() - 1, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) columns_.col(static_cast<Eigen::Index>(c)) = columns[c];
}

Eigen::VectorXd Tones::taken_out(const Eigen::VectorXd& residual) const {
  if (columns_.cols() == 0) return residual;
  return residual - columns_ * columns_.colPivHouseholderQr().solve(residual);
}

}  // namespace bodeflow::residual
