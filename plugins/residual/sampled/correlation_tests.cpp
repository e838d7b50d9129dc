#include "sampled/correlation_tests.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "sampled/noise_model.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kLags = 20;
constexpr Eigen::Index kMostOrder = 10;
constexpr double kDependent = 1e-10;  // of a column's power: what is left of it lies in the space of those before it

/// The signal `lag` rows earlier; rows whose partner lies outside of their stretch are 0.
Eigen::VectorXd lagged(const Eigen::VectorXd& signal, Eigen::Index lag, const Stretches& stretches) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(signal.size());
  const Eigen::Index distance = std::abs(lag);
  for (const Stretch& s : stretches) {
    const Eigen::Index count = s.count - distance;
    if (count <= 0) continue;
    x.segment(s.first + std::max<Eigen::Index>(lag, 0), count) = signal.segment(s.first + std::max<Eigen::Index>(-lag, 0), count);
  }
  return x;
}

/// The stretches without as many rows at their beginning and end, numbered in their own matrix.
Stretches shortened(const Stretches& stretches, Eigen::Index front, Eigen::Index back) {
  Stretches inner;
  for (const Stretch& s : stretches)
    if (s.count > front + back) inner.push_back({s.first + front, s.count - front - back});
  return inner;
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& m, const Stretches& stretches) {
  Eigen::Index count = 0;
  for (const Stretch& s : stretches) count += s.count;
  Eigen::MatrixXd rows(count, m.cols());
  Eigen::Index at = 0;
  for (const Stretch& s : stretches) {
    rows.middleRows(at, s.count) = m.middleRows(s.first, s.count);
    at += s.count;
  }
  return rows;
}

/// Least squares of the last column on the others, one after the other: their Gram matrix swept by Gauss-Jordan steps.
class Sweep {
 public:
  explicit Sweep(const Eigen::MatrixXd& columns)
      : gram_(columns.transpose() * columns), power_(gram_.diagonal()), last_(columns.cols() - 1) {}

  /// Takes the columns from ... to - 1 in; returns how many do not depend on those before them.
  int take(Eigen::Index from, Eigen::Index to) {
    int rank = 0;
    for (Eigen::Index c = from; c < to; ++c) {
      const double pivot = gram_(c, c);
      if (!(power_[c] > 0.0) || !(pivot > kDependent * power_[c])) continue;
      const Eigen::VectorXd column = gram_.col(c);
      gram_ -= column * (column / pivot).transpose();
      ++rank;
    }
    return rank;
  }
  double unexplained() const { return std::max(gram_(last_, last_), 0.0); }

 private:
  Eigen::MatrixXd gram_;
  Eigen::VectorXd power_;
  Eigen::Index last_;
};

/// F test of e on the columns of x, with those of `nuisance` taken out of both.
double joint_p(const Eigen::VectorXd& e, const Eigen::MatrixXd& x, const Eigen::MatrixXd& nuisance) {
  Eigen::MatrixXd columns(e.size(), nuisance.cols() + x.cols() + 1);
  columns << nuisance, x, e;
  Sweep sweep(columns);
  const int out = sweep.take(0, nuisance.cols());
  const double before = sweep.unexplained();
  const int among = sweep.take(nuisance.cols(), nuisance.cols() + x.cols());
  const double unexplained = sweep.unexplained(), rest = static_cast<double>(e.size() - among - out);
  if (among < 1 || rest < 1.0 || !(before > unexplained)) return 1.0;
  if (!(unexplained > 0.0)) return 0.0;
  return f_tail((before - unexplained) / among / (unexplained / rest), among, rest);
}

void find_largest(const Eigen::VectorXd& e, const Eigen::MatrixXd& x, Eigen::Index first_lag, Correlation& c) {
  const Eigen::VectorXd centred = e.array() - e.mean();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Eigen::VectorXd u = x.col(i).array() - x.col(i).mean();
    const double power = centred.norm() * u.norm();
    const double r = power > 0.0 ? centred.dot(u) / power : 0.0;
    if (std::abs(r) <= std::abs(c.largest)) continue;
    c.largest = r;
    c.lag = first_lag + i;
  }
}

double ljung_box(const Eigen::VectorXd& e, const Stretches& stretches, Eigen::Index lags) {
  const Eigen::MatrixXd rows = rows_of(e, stretches);
  const double power = rows.squaredNorm();
  const auto n = static_cast<double>(rows.rows());
  if (!(power > 0.0)) return 1.0;
  double q = 0.0;
  for (Eigen::Index k = 1; k <= lags; ++k) {
    const double r = lagged(e, k, stretches).dot(e) / power;
    q += r * r / (n - static_cast<double>(k));
  }
  return numerics::chi_squared_tail(n * (n + 2.0) * q, static_cast<double>(lags));
}

/// The signal at lags first .. first + count - 1 in columns.
Eigen::MatrixXd regressors(const Eigen::VectorXd& signal, Eigen::Index first, Eigen::Index count, const Stretches& stretches) {
  Eigen::MatrixXd x(signal.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) x.col(i) = lagged(signal, first + i, stretches);
  return x;
}

Eigen::MatrixXd centred(Eigen::MatrixXd m) { return m.rowwise() - m.colwise().mean(); }

}  // namespace

Correlations correlate(const Eigen::VectorXd& residual, const Eigen::VectorXd& input, const Eigen::MatrixXd& jacobian,
                       const Stretches& stretches) {
  Eigen::Index shortest = residual.size();
  for (const Stretch& s : stretches) shortest = std::min(shortest, s.count);
  const Eigen::Index lags = std::min(kLags, shortest / 8), order = noise_order(residual, stretches, std::min(kMostOrder, lags));
  const NoiseModel noise = fit_noise(residual, stretches, order);
  // Rows whose partners at all lags are there.
  const Stretches inner = shortened(stretches, lags + order, 0), before_end = shortened(stretches, order, lags);
  Correlations c;
  if (lags < 1 || inner.empty() || !(noise.variance > 0.0)) return c;
  c.whiteness_p = ljung_box(residual, stretches, lags);
  c.colour = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()) / noise.variance);

  const auto whitened = [&](const Eigen::MatrixXd& m) {
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(m.rows(), m.cols());
    const Eigen::MatrixXd short_rows = innovations(noise, m, stretches);
    Eigen::Index at = 0;
    for (const Stretch& s : stretches) {
      w.middleRows(s.first + order, s.count - order) = short_rows.middleRows(at, s.count - order);
      at += s.count - order;
    }
    return w;
  };
  const Eigen::VectorXd e = whitened(residual), u = whitened(input);
  const Eigen::MatrixXd out = jacobian.cols() > 0 ? whitened(jacobian) : Eigen::MatrixXd(residual.size(), 0);

  const Eigen::VectorXd e_past = rows_of(e, inner);
  const Eigen::MatrixXd past = rows_of(regressors(u, 0, lags + 1, stretches), inner);
  c.input.p = joint_p(e_past, past, rows_of(out, inner));
  find_largest(e_past, past, 0, c.input);

  const Eigen::VectorXd square = e_past.cwiseAbs2(), u_square = input.cwiseAbs2();
  const Eigen::MatrixXd past_squares = rows_of(regressors(u_square, 0, lags + 1, stretches), inner);
  c.input_square.p = joint_p(centred(square), centred(past_squares), Eigen::MatrixXd(square.size(), 0));
  find_largest(square, past_squares, 0, c.input_square);

  if (!before_end.empty()) {
    const Eigen::VectorXd e_future = rows_of(e, before_end);
    const Eigen::MatrixXd future = rows_of(regressors(u, -lags, lags, stretches), before_end);
    // What goes with the present input already is no feedback.
    Eigen::MatrixXd beside(e_future.size(), out.cols() + lags + 1);
    beside << rows_of(out, before_end), rows_of(regressors(u, 0, lags + 1, stretches), before_end);
    c.future.p = joint_p(e_future, future, beside);
    find_largest(e_future, future, -lags, c.future);
  }
  return c;
}

}  // namespace bodeflow::residual
