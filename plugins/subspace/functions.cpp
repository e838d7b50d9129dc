#include "functions.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "sanathanan_koerner/arnoldi.hpp"
#include "sanathanan_koerner/stacked.hpp"

namespace bodeflow::subspace {
namespace {

using Complex = std::complex<double>;

Eigen::VectorXd scaled_weights(const Lines& lines) { return lines.weight / std::sqrt(static_cast<double>(lines.size())); }

double rho_of(double alpha) { return std::sqrt((1.0 - alpha) * (1.0 + alpha)); }

// h of z q_j = rho_j q_{j+1} + alpha_j q*_j, with q*_j = rho q*_{j-1} - alpha_{j-1} q_j spelt out.
Eigen::MatrixXd shift_of(const Eigen::VectorXd& alpha) {
  const Eigen::Index steps = alpha.size();
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(steps + 1, steps);
  Eigen::VectorXd reversed = Eigen::VectorXd::Zero(steps + 1);
  reversed[0] = 1.0;
  for (Eigen::Index j = 0; j < steps; ++j) {
    h.col(j) = alpha[j] * reversed;
    h(j + 1, j) += rho_of(alpha[j]);
    reversed *= rho_of(alpha[j]);
    reversed[j + 1] = -alpha[j];
  }
  return h;
}

}  // namespace

Expected<Functions> functions_of(const Lines& lines, const Plane& plane, Eigen::Index count, Basis basis) {
  const Eigen::VectorXcd z = plane.circle(lines.omega_rad_s);
  const Eigen::VectorXd weight = scaled_weights(lines);
  auto found = sanathanan_koerner::arnoldi(z, weight, count - 1);
  if (!found) return unexpected(found.error().text);
  if (basis == Basis::arnoldi) return Functions{{found->hessenberg, 1.0 / found->scale}, std::move(found->vectors), {}};
  Functions powers;
  powers.rule.shift = Eigen::MatrixXd::Zero(count, count - 1);
  powers.rule.shift.diagonal(-1).setOnes();
  powers.values.resize(2 * lines.size(), count);
  Eigen::VectorXcd power = weight.cast<Complex>();
  for (Eigen::Index j = 0; j < count; ++j) {
    powers.values.col(j) = sanathanan_koerner::stacked(power);
    power = power.cwiseProduct(z);
  }
  powers.orthonormal = std::move(found->vectors);
  return powers;
}

Expected<LongFunctions> LongFunctions::make(const Lines& lines, const Plane& plane, Eigen::Index count) {
  LongFunctions f;
  f.z_ = plane.circle(lines.omega_rad_s);
  f.weight_ = scaled_weights(lines);
  const double norm = f.weight_.norm();
  f.weight_ /= norm;
  f.alpha_.resize(count - 1);
  Eigen::VectorXcd q = f.weight_.cast<Complex>(), reversed = q, next;
  for (Eigen::Index j = 0; j + 1 < count; ++j) {
    next = f.z_.cwiseProduct(q);
    const double alpha = reversed.dot(next).real();
    const double rho = std::abs(alpha) < 1.0 ? rho_of(alpha) : 0.0;
    if (!(rho > 1e-12)) return unexpected("the lines allow no more than " + std::to_string(j + 1) + " basis functions");
    q = (next - alpha * reversed) / rho;
    reversed = rho * reversed - alpha * q;
    f.alpha_[j] = alpha;
  }
  f.rule_ = {shift_of(f.alpha_), 1.0 / norm};
  return f;
}

Eigen::MatrixXd LongFunctions::block(Eigen::Index first, Eigen::Index size) const {
  Eigen::MatrixXd values(2 * size, alpha_.size() + 1);
  const Eigen::VectorXcd z = z_.segment(first, size);
  Eigen::VectorXcd q = weight_.segment(first, size).cast<Complex>(), reversed = q;
  for (Eigen::Index j = 0; j <= alpha_.size(); ++j) {
    values.col(j) << q.real(), q.imag();
    if (j == alpha_.size()) break;
    const double alpha = alpha_[j], rho = rho_of(alpha);
    q = (z.cwiseProduct(q) - alpha * reversed) / rho;
    reversed = rho * reversed - alpha * q;
  }
  return values;
}

double LongFunctions::defect(Eigen::Index block_size) const {
  const Eigen::Index count = alpha_.size() + 1;
  Eigen::MatrixXd signs(count, 3);
  for (Eigen::Index j = 0; j < count; ++j) signs.row(j) << 1.0, j % 2 == 0 ? 1.0 : -1.0, j % 4 < 2 ? 1.0 : -1.0;
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(count, 3);
  for (Eigen::Index k = 0; k < z_.size(); k += block_size) {
    const Eigen::MatrixXd V = block(k, std::min(block_size, z_.size() - k));
    product.noalias() += V.transpose() * (V * signs);
  }
  return (product - signs).cwiseAbs().maxCoeff();
}

}  // namespace bodeflow::subspace
