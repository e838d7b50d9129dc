#include "autoregression.hpp"

#include <cmath>
#include <limits>

namespace bodeflow::validation {

Autoregression fit_autoregression(const Eigen::VectorXd& record, Eigen::Index most) {
  const Eigen::Index samples = record.size();
  most = std::max<Eigen::Index>(0, std::min(most, samples / 10));
  const auto n = static_cast<double>(samples);
  double variance = samples == 0 ? 0.0 : record.squaredNorm() / n;
  Autoregression best{Eigen::VectorXd(), std::sqrt(variance)};
  if (!(variance > 0.0)) return best;

  const auto criterion = [n](double v, Eigen::Index p) {
    const auto order = static_cast<double>(p);
    return n * std::log(v) + 2.0 * (order + 1.0) * n / (n - order - 2.0);
  };
  double least = criterion(variance, 0);
  Eigen::VectorXd forward = record, backward = record, a;
  for (Eigen::Index p = 1; p <= most; ++p) {
    // Errors of order p - 1 at samples p ... N - 1, forward, and one sample earlier, backward.
    const Eigen::VectorXd f = forward.tail(forward.size() - 1), b = backward.head(backward.size() - 1);
    const double power = f.squaredNorm() + b.squaredNorm();
    if (!(power > 0.0)) break;
    const double k = -2.0 * f.dot(b) / power;
    Eigen::VectorXd next(p);
    next.head(p - 1) = a + k * a.reverse();
    next[p - 1] = k;
    a = std::move(next);
    forward = f + k * b;
    backward = b + k * f;
    variance *= 1.0 - k * k;
    if (!(variance > 0.0)) break;
    if (const double value = criterion(variance, p); value < least) {
      least = value;
      best = {a, std::sqrt(variance)};
    }
  }
  return best;
}

Eigen::VectorXd predict(const Autoregression& noise, const Eigen::VectorXd& record, Eigen::Index steps) {
  const Eigen::Index order = noise.coefficients.size();
  Eigen::VectorXd predicted = Eigen::VectorXd::Zero(record.size());
  if (order == 0) return predicted;
  // Row k of `ahead` gives the (k+1)-step prediction from the last `order` samples, the newest first.
  Eigen::RowVectorXd ahead = -noise.coefficients.transpose();
  for (Eigen::Index k = 1; k < steps; ++k) {
    Eigen::RowVectorXd next = -ahead[0] * noise.coefficients.transpose();
    next.head(order - 1) += ahead.tail(order - 1);
    ahead = next;
  }
  for (Eigen::Index n = steps; n < record.size(); ++n) {
    const Eigen::Index newest = n - steps, count = std::min(order, newest + 1);
    predicted[n] = ahead.head(count) * record.segment(newest - count + 1, count).reverse();
  }
  return predicted;
}

double prediction_deviation(const Autoregression& noise, Eigen::Index steps) {
  const Eigen::Index order = noise.coefficients.size();
  Eigen::VectorXd psi = Eigen::VectorXd::Zero(steps);
  psi[0] = 1.0;
  for (Eigen::Index i = 1; i < steps; ++i)
    for (Eigen::Index j = 1; j <= std::min(i, order); ++j) psi[i] -= noise.coefficients[j - 1] * psi[i - j];
  return noise.std * psi.norm();
}

}  // namespace bodeflow::validation
