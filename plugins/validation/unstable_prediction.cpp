#include "unstable_prediction.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace bodeflow::validation {
namespace {

/// The polynomial of these roots, descending powers.
Eigen::VectorXd polynomial(const Eigen::VectorXcd& roots) {
  Eigen::VectorXcd p = Eigen::VectorXcd::Zero(roots.size() + 1);
  p[0] = 1.0;
  for (Eigen::Index i = 0; i < roots.size(); ++i)
    for (Eigen::Index k = i + 1; k > 0; --k) p[k] -= roots[i] * p[k - 1];
  return p.real();
}

}  // namespace

UnstablePrediction predict_unstable(const numerics::StateSpace& system, const Eigen::VectorXd& input,
                                    const Eigen::VectorXd& output, Eigen::Index steps, bool offset) {
  const Eigen::Index order = system.states(), samples = output.size();
  Eigen::VectorXcd roots = system.A.eigenvalues();
  const Eigen::VectorXd a = polynomial(roots);
  for (std::complex<double>& z : roots)
    if (std::abs(z) > 1.0) z = 1.0 / std::conj(z);
  const Eigen::VectorXd f = polynomial(roots);
  // Impulse response of the model, then B = A times it.
  Eigen::VectorXd impulse(order + 1), b = Eigen::VectorXd::Zero(order + 1);
  impulse[0] = system.D(0, 0);
  Eigen::VectorXd x = system.B.col(0);
  for (Eigen::Index i = 1; i <= order; ++i, x = system.A * x) impulse[i] = system.C.row(0).dot(x);
  for (Eigen::Index i = 0; i <= order; ++i) b[i] = a.head(i + 1).dot(impulse.head(i + 1).reverse());

  UnstablePrediction p;
  p.innovation = Eigen::VectorXd::Zero(samples);
  for (Eigen::Index n = order; n < samples; ++n) {
    double e = 0.0;
    for (Eigen::Index i = 0; i <= order; ++i) e += a[i] * output[n - i] - b[i] * input[n - i];
    for (Eigen::Index i = 1; i <= order; ++i) e -= f[i] * p.innovation[n - i];
    p.innovation[n] = e;
  }
  auto known = p.innovation.tail(samples - order);
  if (offset) known.array() -= known.mean();
  p.innovation_std = std::sqrt(known.squaredNorm() / static_cast<double>(known.size()));

  Eigen::VectorXd psi = Eigen::VectorXd::Zero(std::min(steps, samples));
  for (Eigen::Index i = 0; i < psi.size(); ++i) {
    psi[i] = i <= order ? f[i] : 0.0;
    for (Eigen::Index j = 1; j <= std::min(i, order); ++j) psi[i] -= a[j] * psi[i - j];
  }
  p.output = output;
  for (Eigen::Index n = 0; n < samples; ++n) {
    const Eigen::Index count = std::min(psi.size(), n + 1);
    p.output[n] -= psi.head(count).dot(p.innovation.segment(n - count + 1, count).reverse());
  }
  p.expected_error_std = p.innovation_std * psi.norm();
  return p;
}

}  // namespace bodeflow::validation
