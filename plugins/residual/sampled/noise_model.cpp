#include "sampled/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kMostOrder = 10;

Eigen::Index total(const Stretches& stretches) {
  Eigen::Index rows = 0;
  for (const Stretch& s : stretches) rows += s.count;
  return rows;
}

Eigen::Index possible_order(const Stretches& stretches, Eigen::Index most) {
  for (const Stretch& s : stretches) most = std::min(most, s.count / 2);
  return std::max<Eigen::Index>(most, 0);
}

/// Burg's recursion, one order a step.
class Burg {
 public:
  Burg(const Eigen::VectorXd& residual, const Stretches& stretches) : stretches_(stretches) {
    forward_ = backward_ = residual;
    model_.variance = residual.squaredNorm() / static_cast<double>(total(stretches));
  }

  const NoiseModel& model() const { return model_; }

  /// False where nothing is left to predict.
  bool step() {
    const Eigen::Index p = model_.coefficients.size() + 1;
    double product = 0.0, power = 0.0;
    for (const Stretch& s : stretches_) {
      const auto f = forward_.segment(s.first + p, s.count - p), b = backward_.segment(s.first + p - 1, s.count - p);
      product += f.dot(b);
      power += f.squaredNorm() + b.squaredNorm();
    }
    if (!(power > 0.0)) return false;
    const double k = -2.0 * product / power;
    for (const Stretch& s : stretches_) {
      for (Eigen::Index n = s.first + s.count - 1; n >= s.first + p; --n) {
        const double f = forward_[n], b = backward_[n - 1];
        forward_[n] = f + k * b;
        backward_[n] = b + k * f;
      }
    }
    Eigen::VectorXd next(p);
    next.head(p - 1) = model_.coefficients + k * model_.coefficients.reverse();
    next[p - 1] = k;
    model_.coefficients = std::move(next);
    model_.variance *= std::max(1.0 - k * k, 0.0);
    return model_.variance > 0.0;
  }

 private:
  const Stretches& stretches_;
  Eigen::VectorXd forward_, backward_;
  NoiseModel model_;
};

}  // namespace

NoiseModel fit_noise(const Eigen::VectorXd& residual, const Stretches& stretches, Eigen::Index order) {
  Burg burg(residual, stretches);
  for (Eigen::Index p = 0; p < possible_order(stretches, order); ++p)
    if (!burg.step()) break;
  return burg.model();
}

Eigen::Index noise_order(const Eigen::VectorXd& residual, const Stretches& stretches, Eigen::Index most) {
  Burg burg(residual, stretches);
  const auto n = static_cast<double>(total(stretches));
  Eigen::Index best = 0;
  double least = std::numeric_limits<double>::infinity();
  most = possible_order(stretches, most);
  for (Eigen::Index p = 0; p <= most; ++p) {
    const double order = static_cast<double>(p), variance = burg.model().variance;
    if (!(variance > 0.0)) break;
    const double criterion = n * std::log(variance) + 2.0 * (order + 1.0) * n / std::max(n - order - 2.0, 1.0);
    if (criterion < least) {
      least = criterion;
      best = p;
    }
    if (p < most && !burg.step()) break;
  }
  return best;
}

Eigen::MatrixXd innovations(const NoiseModel& noise, const Eigen::MatrixXd& rows, const Stretches& stretches) {
  const Eigen::Index order = noise.coefficients.size();
  Eigen::Index count = 0;
  for (const Stretch& s : stretches) count += std::max<Eigen::Index>(s.count - order, 0);
  Eigen::MatrixXd w(count, rows.cols());
  Eigen::Index at = 0;
  for (const Stretch& s : stretches) {
    const Eigen::Index length = s.count - order;
    if (length <= 0) continue;
    auto part = w.middleRows(at, length);
    part = rows.middleRows(s.first + order, length);
    for (Eigen::Index k = 1; k <= order; ++k) part += noise.coefficients[k - 1] * rows.middleRows(s.first + order - k, length);
    at += length;
  }
  return w;
}

double likelihood_gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const Stretches& stretches) {
  const Eigen::Index order = std::max(noise_order(before, stretches, kMostOrder), noise_order(after, stretches, kMostOrder));
  const double s0 = fit_noise(before, stretches, order).variance, s1 = fit_noise(after, stretches, order).variance;
  if (!(s0 > 0.0)) return 0.0;
  if (!(s1 > 0.0)) return std::numeric_limits<double>::infinity();
  return static_cast<double>(total(stretches)) * std::log(s0 / s1);
}

}  // namespace bodeflow::residual
