#include "mode_covariance.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <bodeflow/numerics/levenberg_marquardt.hpp>

#include "sanathanan_koerner/partial_fractions.hpp"
#include "sanathanan_koerner/vector_fitting.hpp"

namespace bodeflow::validation {
namespace {

using namespace sanathanan_koerner;
using Complex = std::complex<double>;

constexpr double kDependent = 1e-10;  // of columns of length 1

Eigen::MatrixXd weighted_columns(const Data& data, const Eigen::MatrixXcd& m) {
  const Eigen::VectorXcd w = data.weights_of(0).cast<Complex>();
  Eigen::MatrixXd s(2 * m.rows(), m.cols());
  s << (w.asDiagonal() * m).real(), (w.asDiagonal() * m).imag();
  return s;
}

/// dG/d re(p) and dG/d im(p) of a pair with residue R at p.
void add_pair(const Eigen::VectorXcd& s, Complex p, Complex R, Eigen::Ref<Eigen::MatrixXcd> columns) {
  const Eigen::ArrayXcd above = R * (s.array() - p).inverse().square();
  const Eigen::ArrayXcd below = std::conj(R) * (s.array() - std::conj(p)).inverse().square();
  columns.col(0) = above + below;
  columns.col(1) = Complex(0.0, 1.0) * (above - below);
}

}  // namespace

Expected<std::vector<Eigen::Matrix2d>> mode_covariances(const Data& data, const Eigen::VectorXcd& poles,
                                                        const std::vector<Complex>& wanted) {
  const auto set = pole_set(poles);
  if (!set) return unexpected(set.error().text);
  const auto model = fit_residues(data, *set);
  if (!model) return unexpected(model.error().text);
  const Eigen::VectorXcd s = data.omega_rad_s.cast<Complex>() * Complex(0.0, 1.0);
  const auto count = static_cast<Eigen::Index>(wanted.size()), order = set->order();
  Eigen::MatrixXcd slopes = Eigen::MatrixXcd::Zero(data.lines(), 2 * count);
  Eigen::MatrixXcd others(data.lines(), 2 * order + 1 - 2 * count);
  Eigen::Index at = order + 1, n = 0;
  others.leftCols(at) = partial_fractions_at(*set, data.omega_rad_s);
  for (const Complex p : set->pairs) {
    const Complex R(model->coefficients(n, 0), model->coefficients(n + 1, 0));
    const auto place = std::find(wanted.begin(), wanted.end(), p);
    if (place != wanted.end()) {
      add_pair(s, p, R, slopes.middleCols(2 * (place - wanted.begin()), 2));
    } else {
      add_pair(s, p, R, others.middleCols(at, 2));
      at += 2;
    }
    n += 2;
  }
  for (const double p : set->real) others.col(at++) = model->coefficients(n++, 0) * (s.array() - p).inverse().square().matrix();
  Eigen::MatrixXd span = weighted_columns(data, others);
  span.array().rowwise() /= span.colwise().norm().array().max(1e-300);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(span);
  qr.setThreshold(kDependent);
  Eigen::MatrixXd left = qr.householderQ().transpose() * weighted_columns(data, slopes);
  left.topRows(qr.rank()).setZero();
  const auto inverse = numerics::inverse_normal_matrix(left);
  if (!inverse) return unexpected(inverse.error().text);
  std::vector<Eigen::Matrix2d> covariances;
  for (Eigen::Index i = 0; i < count; ++i)
    covariances.push_back(0.5 *
                          inverse->block(2 * i, 2 * i, 2, 2));  // of each real component: half of that of the complex residual
  return covariances;
}

}  // namespace bodeflow::validation
