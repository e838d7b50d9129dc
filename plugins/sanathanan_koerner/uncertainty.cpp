#include "uncertainty.hpp"

#include <Eigen/QR>
#include <bodeflow/numerics/levenberg_marquardt.hpp>

namespace bodeflow::sanathanan_koerner {
namespace {

using Complex = std::complex<double>;

Eigen::MatrixXd stacked_columns(const Eigen::MatrixXcd& m) {
  Eigen::MatrixXd s(2 * m.rows(), m.cols());
  s << m.real(), m.imag();
  return s;
}

/// dH/d(re p), dH/d(im p) of each pair, dH/dp of each real pole, at the lines.
Eigen::MatrixXcd pole_slopes(const PartialFractions& m, const Eigen::VectorXd& omega, Eigen::Index channel) {
  const Complex j(0.0, 1.0);
  Eigen::MatrixXcd slopes(omega.size(), m.poles.order());
  Eigen::Index n = 0;
  for (const Complex p : m.poles.pairs) {
    const Complex R(m.coefficients(n, channel), m.coefficients(n + 1, channel));
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      const Complex above = R / ((j * omega[k] - p) * (j * omega[k] - p));
      const Complex below = std::conj(R) / ((j * omega[k] - std::conj(p)) * (j * omega[k] - std::conj(p)));
      slopes(k, n) = above + below;
      slopes(k, n + 1) = j * (above - below);
    }
    n += 2;
  }
  for (const double p : m.poles.real) {
    slopes.col(n) = m.coefficients(n, channel) * (j * omega.cast<Complex>().array() - p).inverse().square();
    ++n;
  }
  return slopes;
}

/// The covariance of the poles alone: the residues of each channel are projected out.
Expected<Eigen::MatrixXd> of_poles(const Data& data, const PartialFractions& m) {
  const Eigen::Index M = m.poles.order(), rows = 2 * data.lines();
  const Eigen::MatrixXcd functions = partial_fractions_at(m.poles, data.omega_rad_s);
  Eigen::MatrixXd work = Eigen::MatrixXd::Zero(M + rows, M);
  for (Eigen::Index i = 0; i < data.channels(); ++i) {
    const Eigen::VectorXcd weight = data.weights_of(i).cast<Complex>();
    Eigen::MatrixXd span = stacked_columns(weight.asDiagonal() * functions);
    span.array().rowwise() /= span.colwise().norm().array().max(1e-300);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(span);
    Eigen::MatrixXd left =
        qr.householderQ().transpose() * stacked_columns(weight.asDiagonal() * pole_slopes(m, data.omega_rad_s, i));
    left.topRows(M + 1).setZero();
    work.bottomRows(rows) = left;
    Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> fold(work);
    work.topRows(M).triangularView<Eigen::StrictlyLower>().setZero();
  }
  auto inverse = numerics::inverse_normal_matrix(work.topRows(M));
  if (!inverse) return unexpected(inverse.error().text);
  return std::move(*inverse);
}

Expected<Eigen::MatrixXd> of_all(const Data& data, const PartialFractions& m) {
  const Eigen::Index M = m.poles.order(), rows = 2 * data.lines(), n = M + 1;
  const Eigen::MatrixXcd functions = partial_fractions_at(m.poles, data.omega_rad_s);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows * data.channels(), M + n * data.channels());
  for (Eigen::Index i = 0; i < data.channels(); ++i) {
    const Eigen::VectorXcd weight = data.weights_of(i).cast<Complex>();
    J.block(i * rows, 0, rows, M) = stacked_columns(weight.asDiagonal() * pole_slopes(m, data.omega_rad_s, i));
    J.block(i * rows, M + i * n, rows, n) = stacked_columns(weight.asDiagonal() * functions);
  }
  auto inverse = numerics::inverse_normal_matrix(J, parameters_of(m).names);
  if (!inverse) return unexpected(inverse.error().text);
  return std::move(*inverse);
}

}  // namespace

Expected<Uncertainty> uncertainty(const Data& data, const PartialFractions& m, double variance) {
  const Eigen::Index M = m.poles.order();
  Uncertainty u;
  if (M == 0) return u;
  const bool few = M + (M + 1) * m.channels() <= kMostParameters;
  auto inverse = few ? of_all(data, m) : of_poles(data, m);
  if (!inverse) return unexpected("no covariance: " + inverse.error().text);
  const Eigen::MatrixXd c = 0.5 * variance * *inverse;  // of each real component: half of that of the complex residual
  if (few) u.covariance = c;
  const auto pairs = static_cast<Eigen::Index>(m.poles.pairs.size());
  for (Eigen::Index n = 0; n < pairs; ++n) {
    Eigen::Matrix2d one = c.block(2 * n, 2 * n, 2, 2);
    u.poles.push_back(one);
    one(0, 1) = one(1, 0) = -one(0, 1);
    u.poles.push_back(one);
  }
  for (Eigen::Index n = 2 * pairs; n < M; ++n) u.poles.push_back(Eigen::Vector2d(c(n, n), 0.0).asDiagonal());
  return u;
}

FractionParameters parameters_of(const PartialFractions& m) {
  FractionParameters p;
  const Eigen::Index M = m.poles.order();
  p.values.resize(M + (M + 1) * m.channels());
  Eigen::Index at = 0;
  const auto add = [&](const std::string& name, double value) {
    p.names.push_back(name);
    p.values[at++] = value;
  };
  const std::size_t pairs = m.poles.pairs.size();
  for (std::size_t n = 0; n < pairs; ++n) {
    add("pole" + std::to_string(n + 1) + "_re", m.poles.pairs[n].real());
    add("pole" + std::to_string(n + 1) + "_im", m.poles.pairs[n].imag());
  }
  for (std::size_t n = 0; n < m.poles.real.size(); ++n) add("pole" + std::to_string(pairs + n + 1), m.poles.real[n]);
  for (Eigen::Index i = 0; i < m.channels(); ++i) {
    const std::string of = m.channels() > 1 ? "_of" + std::to_string(i + 1) : "";
    for (std::size_t n = 0; n < pairs; ++n) {
      const auto row = static_cast<Eigen::Index>(2 * n);
      add("residue" + std::to_string(n + 1) + "_re" + of, m.coefficients(row, i));
      add("residue" + std::to_string(n + 1) + "_im" + of, m.coefficients(row + 1, i));
    }
    for (std::size_t n = 0; n < m.poles.real.size(); ++n)
      add("residue" + std::to_string(pairs + n + 1) + of, m.coefficients(static_cast<Eigen::Index>(2 * pairs + n), i));
    add("direct" + of, m.coefficients(M, i));
  }
  return p;
}

}  // namespace bodeflow::sanathanan_koerner
