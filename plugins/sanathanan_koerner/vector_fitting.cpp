#include "vector_fitting.hpp"

#include <Eigen/QR>
#include <bodeflow/numerics/hessenberg_eigenvalues.hpp>
#include <cmath>
#include <optional>

#include "elimination.hpp"
#include "race.hpp"
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
  const auto found = numerics::eigenvalues(zeros);
  if (!found) return unexpected("the poles were not found: " + found.error().text);
  auto next = pole_set(*found);
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

/// The range of all lines without one at 0.
Eigen::Vector2d whole_range(const Eigen::VectorXd& omega) {
  const double last = omega[omega.size() - 1] > 0.0 ? omega[omega.size() - 1] : 1.0;
  if (omega[0] > 0.0) return {omega[0], last};
  return {omega.size() > 1 ? omega[1] : last, last};
}

/// The iteration from some poles, one iterate after the other.
class Relocation {
 public:
  Relocation(const Data& data, const Eigen::VectorXd& shared, double norm, const VectorFittingSettings& settings, PoleSet start)
      : data_(&data), shared_(&shared), norm_(norm), settings_(settings), now_{std::move(start), 0} {}

  bool advance() {
    if (!course_.reason.empty()) return false;
    if (!functions_) functions_.emplace(fractions(*data_, *shared_, now_.poles));
    if (!functions_->columns.allFinite()) return end("a pole lies on a line");
    if (now_.poles.order() > 0) {
      auto next = relocated(now_.poles, sigma(), settings_.stable);
      if (!next) return end(next.error().text);
      now_ = std::move(*next);
      functions_.emplace(fractions(*data_, *shared_, now_.poles));
      if (!functions_->columns.allFinite()) return end("a pole lies on a line");
    }
    PartialFractions model = residues_in(*data_, *shared_, now_.poles, *functions_);
    Eigen::MatrixXcd fitted = response(model, data_->omega_rad_s);
    if (note(course_, weighted_residual(*data_, fitted).norm() / norm_))
      best_ = {std::move(model), std::move(fitted), now_.mirrored, {}};
    return !should_stop(course_, settings_.stop) && now_.poles.order() > 0;
  }

  const Course& course() const { return course_; }

  Expected<VectorFit> result() && {
    if (course_.best < 0) return unexpected("no model of order " + std::to_string(now_.poles.order()) + ": " + course_.reason);
    best_.course = std::move(course_);
    return std::move(best_);
  }

 private:
  Eigen::VectorXd sigma() const {
    Eigen::VectorXd relaxed = relaxed_sigma(*data_, *shared_, *functions_, norm_);
    // In units of the columns, whatever the unit of frequency.
    const Eigen::VectorXd scaled = relaxed.cwiseProduct(functions_->length);
    const bool has_zeros = std::abs(scaled[scaled.size() - 1]) > kLeastMean * scaled.norm();
    return has_zeros ? relaxed : plain_sigma(*data_, *functions_);
  }

  bool end(const std::string& why) {
    course_.reason = why;
    return false;
  }

  const Data* data_;
  const Eigen::VectorXd* shared_;
  double norm_;
  VectorFittingSettings settings_;
  Relocated now_;
  std::optional<Fractions> functions_;  // of the poles now
  VectorFit best_;
  Course course_;
};

Expected<VectorFit> best_from(const Data& data, const VectorFittingSettings& settings, const std::vector<PoleSet>& starts) {
  const Eigen::VectorXd shared = shared_weights(data);
  const double norm = weighted_norm(data);
  std::vector<Relocation> runners;
  for (const PoleSet& start : starts) runners.emplace_back(data, shared, norm, settings, start);
  Relocation* const best = race(runners);
  return std::move(best != nullptr ? *best : runners.front()).result();
}

}  // namespace

PoleSet initial_poles(const Eigen::Vector2d& range, Eigen::Index order, Spacing spacing) {
  const double first = range[0], last = range[1];
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

std::vector<PoleSet> starting_poles(const Data& data, Eigen::Index order, Spacing spacing) {
  const Eigen::Vector2d active = active_range(data), whole = whole_range(data.omega_rad_s);
  if (spacing != Spacing::automatic) return {initial_poles(active, order, spacing)};
  if (order == 0) return {PoleSet{}};
  return {initial_poles(active, order, Spacing::linear), initial_poles(whole, order, Spacing::linear),
          initial_poles(whole, order, Spacing::logarithmic)};
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
  const Eigen::Vector2d whole = whole_range(data.omega_rad_s);
  return last > first ? Eigen::Vector2d(std::max(data.omega_rad_s[first], whole[0]), data.omega_rad_s[last]) : whole;
}

Expected<PartialFractions> fit_residues(const Data& data, const PoleSet& poles) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, poles.order()); !good) return unexpected(good.error().text);
  const Eigen::VectorXd q = shared_weights(data);
  return residues_in(data, q, poles, fractions(data, q, poles));
}

Expected<VectorFit> vector_fit(const Data& data, const VectorFittingSettings& settings) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, settings.order); !good) return unexpected(good.error().text);
  return best_from(data, settings, starting_poles(data, settings.order, settings.initial_poles));
}

Expected<VectorFit> vector_fit(const Data& data, const VectorFittingSettings& settings, const PoleSet& start) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, start.order()); !good) return unexpected(good.error().text);
  return best_from(data, settings, {start});
}

}  // namespace bodeflow::sanathanan_koerner
