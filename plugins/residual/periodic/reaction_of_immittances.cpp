#include "periodic/reaction_of_immittances.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace bodeflow::residual {
namespace {

constexpr int kMostRounds = 40;
constexpr std::size_t kMixed = 5;
// Part of the reactions; derivatives by differences of 1e-5 want no more noise.
constexpr double kAgree = 1e-9;

/// The reactions that the immittances make of a flow, at its samples.
Eigen::MatrixXd reactions(const SampledPath& path, const Eigen::MatrixXd& flow, double sample_time_s) {
  const Eigen::Index n = flow.rows(), m = flow.cols();
  Eigen::MatrixXcd lines(n, m);
  for (Eigen::Index p = 0; p < m; ++p) lines.col(p) = numerics::dft(Eigen::VectorXd(flow.col(p)));
  const double line_hz = 1.0 / (sample_time_s * static_cast<double>(n));
  for (Eigen::Index k = 0; k <= n / 2; ++k) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * line_hz * static_cast<double>(k));
    Eigen::VectorXcd z = path.path().immittances(s);
    for (Eigen::Index p = 0; p < m; ++p)
      if (!std::isfinite(z[p].real()) || !std::isfinite(z[p].imag())) z[p] = 0.0;  // a pole at 0: without a direct part
    lines.row(k) = lines.row(k).cwiseProduct(z.transpose()).eval();
    if (k > 0 && k < n - k) lines.row(n - k) = lines.row(k).conjugate();
    if (k == n - k || k == 0) lines.row(k) = lines.row(k).real().eval();
  }
  Eigen::MatrixXd w(n, m);
  for (Eigen::Index p = 0; p < m; ++p) w.col(p) = numerics::inverse_dft(Eigen::VectorXcd(lines.col(p))).real();
  return w;
}

/// The next guess from guesses and what became of them.
Eigen::VectorXd mixed(const std::vector<Eigen::VectorXd>& guesses, const std::vector<Eigen::VectorXd>& changes) {
  const Eigen::VectorXd& last = changes.back();
  if (changes.size() < 2) return guesses.back() + last;
  const auto columns = static_cast<Eigen::Index>(changes.size() - 1);
  Eigen::MatrixXd of_change(last.size(), columns), of_guess(last.size(), columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    const auto i = static_cast<std::size_t>(c);
    of_change.col(c) = changes[i + 1] - changes[i];
    of_guess.col(c) = guesses[i + 1] - guesses[i];
  }
  const Eigen::VectorXd weight = of_change.colPivHouseholderQr().solve(last);
  return guesses.back() + last - (of_guess + of_change) * weight;
}

}  // namespace

Expected<Simulated> simulate_with_immittances(const JointModel& model, const Eigen::VectorXd& values,
                                              std::span<const double> known, const SampledPath& path, Drive drive) {
  drive.signals = true;
  const auto places = static_cast<Eigen::Index>(model.base->places().size());
  const Eigen::Index samples = drive.input.rows() / drive.values_per_sample;
  std::vector<Eigen::VectorXd> guesses = {Eigen::VectorXd::Zero(samples * places)}, changes;
  for (int round = 0; round < kMostRounds; ++round) {
    drive.extra_reaction = guesses.back().reshaped(samples, places);
    if (drive.values_per_sample > 1) drive.extra_reaction = refined(drive.extra_reaction, drive.values_per_sample);
    auto s = simulate(model, values, known, drive);
    if (!s) return s;
    if (!s->flow.allFinite()) return refused("the simulation with immittances is not finite");
    changes.push_back(Eigen::VectorXd(reactions(path, s->flow.topRows(samples), drive.sample_time_s).reshaped()) -
                      guesses.back());
    if (changes.back().norm() <= kAgree * (guesses.back() + changes.back()).norm()) return s;
    guesses.push_back(mixed(guesses, changes));
    if (changes.size() > kMixed) {
      guesses.erase(guesses.begin());
      changes.erase(changes.begin());
    }
  }
  return refused("immittances and laws do not come to an agreement within " + std::to_string(kMostRounds) + " simulations");
}

}  // namespace bodeflow::residual
