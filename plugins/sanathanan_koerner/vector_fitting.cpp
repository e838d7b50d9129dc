#include "vector_fitting.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

#include "elimination.hpp"
#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

using Complex = std::complex<double>;

constexpr double kDamping = 0.01;     // of the initial poles: their real part over their imaginary part
constexpr double kRestOfWay = 0.005;  // of the response's way, on either side of the active range
constexpr double kLeastMean = 1e-8;   // of sigma at infinity beside its norm: below, the relaxed form has no zeros to give

/// The functions of the poles with the shared weights, stacked, columns of unit length.
struct Fractions {
  Eigen::MatrixXd columns;
  Eigen::VectorXd length;
  Elimination elimination;
};

Fractions fractions(const Data& data, const Eigen::VectorXd& q, const PoleSet& poles) {
  Eigen::MatrixXcd f = partial_fractions_at(poles, data.omega_rad_s);
  f.array().colwise() *= q.array().cast<Complex>();
  Eigen::MatrixXd columns(2 * f.rows(), f.cols());
  columns << f.real(), f.imag();
  Eigen::VectorXd length = columns.colwise().norm();
  for (double& l : length)
    if (l == 0.0) l = 1.0;
  columns *= length.cwiseInverse().asDiagonal();
  Elimination elimination(data, q, columns, false);
  return {std::move(columns), std::move(length), std::move(elimination)};
}

PartialFractions residues_in(const Data& data, const Eigen::VectorXd& q, const PoleSet& poles, const Fractions& at) {
  PartialFractions m{poles, Eigen::MatrixXd(poles.order() + 1, data.channels())};
  for (Eigen::Index i = 0; i < data.channels(); ++i) {
    const Eigen::VectorXcd aim = at.elimination.ratio(i).cwiseProduct(q).cwiseProduct(data.response.col(i));
    m.coefficients.col(i) = at.elimination.coefficients(i, stacked(aim)).cwiseQuotient(at.length);
  }
  return m;
}

/// sigma: coefficients of the fractions, then the constant.
Eigen::VectorXd relaxed_sigma(const Data& data, const Eigen::VectorXd& q, const Fractions& at, double norm) {
  Eigen::MatrixXcd factors(data.lines(), data.channels());
  for (Eigen::Index i = 0; i < data.channels(); ++i) factors.col(i) = at.elimination.ratio(i).cwiseProduct(data.response.col(i));
  const Eigen::MatrixXd R = condensed(at.elimination, factors, at.columns);
  const auto lines = static_cast<double>(data.lines());
  const double scale = norm / lines;
  Eigen::MatrixXd rows(R.rows() + 1, R.cols());
  rows.topRows(R.rows()) = R;
  // Sum of Re(sigma) with the weights q: the columns carry them.
  rows.row(R.rows()) = scale * at.columns.topRows(data.lines()).colwise().sum();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows.rows());
  right[R.rows()] = scale * q.sum();
  return rows.colPivHouseholderQr().solve(right).cwiseQuotient(at.length);
}

/// sigma with its constant at 1, where the relaxed one has none.
Eigen::VectorXd plain_sigma(const Data& data, const Fractions& at) {
  Eigen::MatrixXcd factors(data.lines(), data.channels());
  for (Eigen::Index i = 0; i < data.channels(); ++i) factors.col(i) = at.elimination.ratio(i).cwiseProduct(data.response.col(i));
  const Eigen::MatrixXd R = condensed(at.elimination, factors, at.columns);
  const Eigen::Index n = R.cols() - 1;
  Eigen::VectorXd c(n + 1);
  c.head(n) = R.leftCols(n).colPivHouseholderQr().solve(-R.col(n) * at.length[n]).cwiseQuotient(at.length.head(n));
  c[n] = 1.0;
  return c;
}

struct Relocated {
  PoleSet poles;
  Eigen::Index mirrored = 0;
};

Expected<Relocated> relocated(const PoleSet& poles, const Eigen::VectorXd& sigma, bool stable) {
  const Eigen::Index M = poles.order();
  const ModalPair modal = modal_pair(poles);
  const Eigen::MatrixXd zeros = modal.A - modal.b * sigma.head(M).transpose() / sigma[M];
  if (!zeros.allFinite()) return unexpected("the equations of the poles are not finite");
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(zeros, false);
  if (solver.info() != Eigen::Success) return unexpected("the poles were not found: the eigenvalues did not converge");
  auto next = pole_set(solver.eigenvalues());
  if (!next) return unexpected(next.error().text);
  Relocated r{std::move(*next), 0};
  if (!stable) return r;
  for (Complex& p : r.poles.pairs) {
    if (!(p.real() > 0.0)) continue;
    p = -std::conj(p);
    r.mirrored += 2;
  }
  for (double& p : r.poles.real) {
    if (!(p > 0.0)) continue;
    p = -p;
    ++r.mirrored;
  }
  return r;
}

}  // namespace

PoleSet initial_poles(const Eigen::VectorXd& omega, Eigen::Index order, Spacing spacing) {
  const double last = omega[omega.size() - 1] > 0.0 ? omega[omega.size() - 1] : 1.0;
  double first = omega[0];
  if (first == 0.0) first = omega.size() > 1 ? omega[1] : last;
  const Eigen::Index pairs = order / 2;
  PoleSet poles;
  for (Eigen::Index n = 0; n < pairs; ++n) {
    const double share = pairs > 1 ? static_cast<double>(n) / static_cast<double>(pairs - 1) : 0.5;
    const double w = spacing == Spacing::linear ? first + share * (last - first) : first * std::pow(last / first, share);
    poles.pairs.emplace_back(-kDamping * w, w);
  }
  if (order % 2 == 1) poles.real.push_back(-std::sqrt(first * last));
  return poles;
}

Eigen::Vector2d active_range(const Data& data) {
  const Eigen::MatrixXcd g = weighted_residual(data, Eigen::MatrixXcd::Zero(data.lines(), data.channels()));
  const Eigen::Index steps = data.lines() - 1;
  const Eigen::VectorXd way = (g.bottomRows(steps) - g.topRows(steps)).rowwise().norm();
  const double rest = kRestOfWay * way.sum();
  Eigen::Index first = 0, last = data.lines() - 1;
  for (double gone = 0.0; first < last; ++first) {
    gone += way[first];
    if (gone > rest) break;
  }
  for (double gone = 0.0; last > first; --last) {
    gone += way[last - 1];
    if (gone > rest) break;
  }
  return last > first ? Eigen::Vector2d(data.omega_rad_s[first], data.omega_rad_s[last])
                      : Eigen::Vector2d(data.omega_rad_s[0], data.omega_rad_s[steps]);
}

Expected<PartialFractions> fit_residues(const Data& data, const PoleSet& poles) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, poles.order()); !good) return unexpected(good.error().text);
  const Eigen::VectorXd q = shared_weights(data);
  return residues_in(data, q, poles, fractions(data, q, poles));
}

Expected<VectorFit> vector_fit(const Data& data, const VectorFittingSettings& settings) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  return vector_fit(data, settings, initial_poles(active_range(data), settings.order, settings.initial_poles));
}

Expected<VectorFit> vector_fit(const Data& data, const VectorFittingSettings& settings, const PoleSet& start) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, start.order()); !good) return unexpected(good.error().text);
  const Eigen::VectorXd q = shared_weights(data);
  const double norm = weighted_norm(data);
  VectorFit best;
  Course course;
  Relocated now{start, 0};
  const auto give_up = [&](const std::string& why) -> Expected<VectorFit> {
    if (course.best < 0) return unexpected("no model of order " + std::to_string(start.order()) + ": " + why);
    course.reason = why;
    best.course = course;
    return std::move(best);
  };
  for (bool first = true;; first = false) {
    const Fractions at = fractions(data, q, now.poles);
    if (!at.columns.allFinite()) return give_up("a pole lies on a line");
    if (!first || start.order() == 0) {
      PartialFractions model = residues_in(data, q, now.poles, at);
      Eigen::MatrixXcd fitted = response(model, data.omega_rad_s);
      if (note(course, weighted_residual(data, fitted).norm() / norm))
        best = {std::move(model), std::move(fitted), now.mirrored, {}};
      if (should_stop(course, settings.stop) || start.order() == 0) break;
    }
    Eigen::VectorXd sigma = relaxed_sigma(data, q, at, norm);
    // In units of the columns, whatever the unit of frequency.
    const Eigen::VectorXd scaled = sigma.cwiseProduct(at.length);
    if (!(std::abs(scaled[start.order()]) > kLeastMean * scaled.norm())) sigma = plain_sigma(data, at);
    auto next = relocated(now.poles, sigma, settings.stable);
    if (!next) return give_up(next.error().text);
    now = std::move(*next);
  }
  if (course.best < 0) return give_up(course.reason);
  best.course = course;
  return best;
}

}  // namespace bodeflow::sanathanan_koerner
