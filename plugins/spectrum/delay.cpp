#include "delay.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 6.283185307179586476925;
constexpr double kPointsAPeriod = 16.0;
constexpr double kMostEvaluations = 1e9;
constexpr int kSteps = 50;

/// The criterion for one band.
class Criterion {
 public:
  explicit Criterion(const DelayProblem& p) : omega_(kTwoPi * p.frequency_hz), h_(p.response), weight_(p.response.size()) {
    for (Eigen::Index k = 0; k < h_.size(); ++k) {
      const Complex slope = std::pow(Complex(0.0, omega_[k]), p.slope);
      h_[k] /= slope;
      weight_[k] = p.variance.size() == 0 ? 1.0 : std::norm(slope) / p.variance[k];
    }
    total_ = weight_.sum();
  }

  /// The best real gain at a delay.
  double gain(double tau) const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < h_.size(); ++k) sum += weight_[k] * (h_[k] * std::polar(1.0, omega_[k] * tau)).real();
    return sum / total_;
  }
  /// J at its best gain, computed from the differences.
  double cost(double tau) const {
    const double a = gain(tau);
    double sum = 0.0;
    for (Eigen::Index k = 0; k < h_.size(); ++k) sum += weight_[k] * std::norm(h_[k] - a * std::polar(1.0, -omega_[k] * tau));
    return sum;
  }
  /// Gauss-Newton from a delay in the basin of a minimum.
  double refine(double tau) const {
    for (int step = 0; step < kSteps; ++step) {
      const double a = gain(tau);
      double slope = 0.0;
      for (Eigen::Index k = 0; k < h_.size(); ++k)
        slope += weight_[k] * omega_[k] * (h_[k] * std::polar(1.0, omega_[k] * tau)).imag();
      const double change = -slope / (a * curvature());
      tau += change;
      if (!(std::abs(change) > 1e-15 * (std::abs(tau) + 1.0 / omega_[omega_.size() - 1]))) break;
    }
    return tau;
  }
  /// sum w omega^2.
  double curvature() const { return (weight_.array() * omega_.array().square()).sum(); }
  double power() const { return (weight_.array() * h_.array().abs2()).sum(); }
  /// w H at each line, and the rotation by one step of the grid.
  std::vector<Complex> weighted() const {
    std::vector<Complex> x;
    for (Eigen::Index k = 0; k < h_.size(); ++k) x.push_back(weight_[k] * h_[k]);
    return x;
  }
  std::vector<Complex> rotation(double step) const {
    std::vector<Complex> x;
    for (Eigen::Index k = 0; k < h_.size(); ++k) x.push_back(std::polar(1.0, omega_[k] * step));
    return x;
  }

 private:
  Eigen::VectorXd omega_;
  Eigen::VectorXcd h_;
  Eigen::VectorXd weight_;
  double total_ = 0.0;
};

/// Re(sum w H exp(j omega tau))^2 on the grid tau = 0, step, ...: greatest where J is least.
std::vector<double> scan(const Criterion& criterion, double step, std::size_t points) {
  std::vector<Complex> x = criterion.weighted();
  const std::vector<Complex> turn = criterion.rotation(step);
  std::vector<double> height(points);
  for (double& h : height) {
    double sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      sum += x[k].real();
      x[k] *= turn[k];
    }
    h = sum * sum;
  }
  return height;
}

/// The grid points that are peaks, highest first, at most two.
std::vector<std::size_t> two_peaks(const std::vector<double>& height) {
  std::vector<std::size_t> peaks;
  for (std::size_t i = 0; i < height.size(); ++i) {
    const bool rises = i == 0 || height[i] > height[i - 1], falls = i + 1 == height.size() || height[i] >= height[i + 1];
    if (rises && falls) peaks.push_back(i);
  }
  const auto higher = [&](std::size_t a, std::size_t b) { return height[a] > height[b]; };
  std::stable_sort(peaks.begin(), peaks.end(), higher);
  if (peaks.size() > 2) peaks.resize(2);
  return peaks;
}

double usual_range(const DelayProblem& p) {
  double spacing = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 1; k < p.frequency_hz.size(); ++k) spacing = std::min(spacing, p.frequency_hz[k] - p.frequency_hz[k - 1]);
  return 0.5 / spacing;
}

}  // namespace

Expected<DelayEstimate> delay_of(const DelayProblem& p) {
  const Eigen::Index lines = p.frequency_hz.size();
  if (lines < 3) return unexpected("the band has " + counted(lines, "line") + "; a delay needs at least 3");
  if (p.response.cwiseAbs().maxCoeff() == 0.0) return unexpected("the response is zero over the whole band");
  DelayEstimate e;
  e.largest_s = p.largest_s > 0.0 ? p.largest_s : usual_range(p);
  const double step = 1.0 / (kPointsAPeriod * p.frequency_hz[lines - 1]);
  const double points = std::floor(e.largest_s / step) + 2.0;
  if (points * static_cast<double>(lines) > kMostEvaluations)
    return unexpected(counted(lines, "line") + " and delays up to " + short_number(e.largest_s) +
                      " s are too many to search; give a smaller band or a smaller largest delay");
  const Criterion criterion(p);
  const auto peaks = two_peaks(scan(criterion, step, static_cast<std::size_t>(points)));
  struct Minimum {
    double tau, cost;
  };
  std::vector<Minimum> minima;
  for (const std::size_t i : peaks) {
    const double tau = criterion.refine(static_cast<double>(i) * step);
    minima.push_back({tau, criterion.cost(tau)});
  }
  if (minima.size() == 2 && minima[1].cost < minima[0].cost) std::swap(minima[0], minima[1]);
  e.delay_s = minima.front().tau;
  e.gain = criterion.gain(e.delay_s);
  const double expected = static_cast<double>(lines) - 1.0, least = minima.front().cost;
  const bool known = p.variance.size() != 0;
  const double scale = known ? std::max(1.0, least / expected) : least / expected;
  e.standard_deviation_s = std::sqrt(scale / (2.0 * criterion.curvature())) / std::abs(e.gain);
  e.misfit = known ? std::sqrt(least / expected) : std::numeric_limits<double>::quiet_NaN();
  e.relative_error = std::sqrt(least / criterion.power());
  e.rival_s = std::numeric_limits<double>::quiet_NaN();
  e.rival_excess = std::numeric_limits<double>::infinity();
  if (minima.size() == 2) {
    e.rival_s = minima[1].tau;
    e.rival_excess = scale > 0.0 ? (minima[1].cost - least) / scale : std::numeric_limits<double>::infinity();
  }
  if (!std::isfinite(e.delay_s) || !std::isfinite(e.standard_deviation_s)) return unexpected("the values are too large");
  return e;
}

}  // namespace bodeflow::spectrum
