#include "fit.hpp"

#include <Eigen/QR>
#include <cmath>

#include "elimination.hpp"
#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr int kScanIterations = 4;

/// The data in the weights of one iterate: basis with w = q / |d|^e and the numerators' part.
struct Weighted {
  Eigen::VectorXd w;
  Basis basis;
  Elimination elimination;
};

Expected<Weighted> weighted(const Data& data, const Eigen::VectorXd& q, const Eigen::VectorXcd& z, const Eigen::VectorXcd& d,
                            double exponent, Eigen::Index order) {
  Eigen::VectorXd w = q.array() / d.array().abs().pow(exponent);
  auto basis = arnoldi(z, w, order);
  if (!basis) return unexpected(basis.error().text);
  Elimination elimination(data, q, basis->vectors, true);
  return Weighted{std::move(w), std::move(*basis), std::move(elimination)};
}

/// The model with denominator d in a basis of weight q/|d|.
Expected<Fit> judged(const Data& data, const Plane& plane, const Weighted& at, const Eigen::VectorXcd& d) {
  Fit f;
  const Eigen::VectorXcd turned = at.w.cwiseProduct(d);  // q times the phase of d
  const Eigen::Index n = at.basis.order() + 1;
  f.denominator = d;
  f.model = {plane, at.basis.hessenberg, at.basis.vectors.transpose() * stacked(turned), Eigen::MatrixXd(n, data.channels()),
             at.basis.scale};
  f.response.resize(data.lines(), data.channels());
  // The model's response comes from its coefficients, so that the error is that of the model and not of the line values.
  const Eigen::VectorXcd below = unstacked(at.basis.vectors * f.model.denominator);
  for (Eigen::Index i = 0; i < data.channels(); ++i) {
    const Eigen::VectorXcd aim = at.elimination.ratio(i).cwiseProduct(turned).cwiseProduct(data.response.col(i));
    f.model.numerators.col(i) = at.elimination.coefficients(i, stacked(aim));
    f.response.col(i) = unstacked(at.basis.vectors * f.model.numerators.col(i)).cwiseQuotient(below);
  }
  // Where the weight is zero the basis has no values: the recurrence has.
  for (Eigen::Index k = 0; k < data.lines(); ++k) {
    if (at.w[k] > 0.0) continue;
    const Eigen::VectorXcd one = plane.circle(data.omega_rad_s.segment(k, 1));
    const Eigen::RowVectorXcd row = polynomials_at(at.basis, one);
    f.response.row(k) =
        row * f.model.numerators.cast<std::complex<double>>() / (row * f.model.denominator.cast<std::complex<double>>())(0);
  }
  return f;
}

/// min |R c|^2 + (row c - aim)^2.
Eigen::VectorXd relaxed_solution(const Eigen::MatrixXd& R, const Eigen::RowVectorXd& row, double aim) {
  Eigen::MatrixXd rows(R.rows() + 1, R.cols());
  rows << R, row;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows.rows());
  right[R.rows()] = aim;
  return rows.colPivHouseholderQr().solve(right);
}

/// One step: the denominator's values at the lines that follow on those of `d`, and its roots.
struct Step {
  Eigen::VectorXcd denominator;
  Eigen::VectorXcd roots;
};

Expected<Step> next_denominator(const Data& data, const Weighted& at, const Eigen::VectorXcd& d, double data_norm) {
  Eigen::MatrixXcd factors(data.lines(), data.channels());
  for (Eigen::Index i = 0; i < data.channels(); ++i) factors.col(i) = at.elimination.ratio(i).cwiseProduct(data.response.col(i));
  const Eigen::MatrixXd R = condensed(at.elimination, factors, at.basis.vectors);
  if (!R.allFinite()) return unexpected("the equations are not finite");
  const double scale = data_norm / static_cast<double>(data.lines());
  Eigen::VectorXcd turn = d.conjugate().cwiseQuotient(d.cwiseAbs().cast<std::complex<double>>());
  const Eigen::RowVectorXd row = stacked(turn.conjugate()).transpose() * at.basis.vectors;
  const Eigen::VectorXd c = relaxed_solution(R, scale * row, scale * static_cast<double>(data.lines()));
  if (!c.allFinite()) return unexpected("the denominator is not finite");
  auto roots = roots_of(at.basis.hessenberg, c);
  if (!roots) return unexpected(roots.error().text);
  const Eigen::VectorXcd values = unstacked(at.basis.vectors * c);
  Step step{d, std::move(*roots)};
  for (Eigen::Index k = 0; k < data.lines(); ++k) {
    if (at.w[k] > 0.0) {
      step.denominator[k] = values[k] / at.w[k];
    } else {
      step.denominator[k] = 1.0;  // of no consequence: the line has no weight
    }
  }
  return step;
}

Eigen::VectorXcd poles_of(const Plane& plane, const Eigen::VectorXcd& roots) {
  return roots.unaryExpr([&](std::complex<double> z) { return plane.pole(z); });
}

}  // namespace

Eigen::Index reflect(const Eigen::VectorXcd& roots, const Eigen::VectorXcd& z, Eigen::VectorXcd& denominator) {
  Eigen::Index count = 0;
  for (const std::complex<double> p : roots) {
    if (!(std::abs(p) > 1.0)) continue;
    ++count;
    const std::complex<double> inside = 1.0 / std::conj(p);
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      const std::complex<double> factor = (z[k] - inside) / (z[k] - p) * std::abs(p);
      if (std::isfinite(std::abs(factor))) denominator[k] *= factor;
    }
  }
  return count;
}

Expected<Fit> with_denominator(const Data& data, const Plane& plane, const Eigen::VectorXcd& denominator, Eigen::Index order) {
  const Eigen::VectorXd q = shared_weights(data);
  const auto at = weighted(data, q, plane.circle(data.omega_rad_s), denominator, 1.0, order);
  if (!at) return unexpected(at.error().text);
  auto f = judged(data, plane, *at, denominator);
  if (!f) return f;
  auto roots = roots_of(f->model.hessenberg, f->model.denominator);
  if (!roots) return unexpected(roots.error().text);
  f->poles = poles_of(plane, *roots);
  note(f->course, weighted_residual(data, f->response).norm() / weighted_norm(data));
  return f;
}

Expected<Fit> fit(const Data& data, const Plane& plane, const FitSettings& settings, const Eigen::VectorXcd& start) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, settings.order); !good) return unexpected(good.error().text);
  const Eigen::VectorXd q = shared_weights(data);
  const double scale = q.norm() / std::sqrt(static_cast<double>(data.lines())), norm = weighted_norm(data);
  const Eigen::VectorXcd z = plane.circle(data.omega_rad_s);
  const Eigen::VectorXd unit = q / scale;
  Data scaled = data;
  scaled.weights /= scale;
  Eigen::VectorXcd d = start.size() > 0 ? start : Eigen::VectorXcd::Ones(data.lines());
  Eigen::VectorXcd roots;
  Fit best;
  Course course;
  Eigen::Index reflected = 0;
  const auto give_up = [&](const std::string& why) -> Expected<Fit> {
    if (course.best < 0) return unexpected("no model of order " + std::to_string(settings.order) + ": " + why);
    course.reason = why;
    best.course = course;
    return std::move(best);
  };
  for (bool first = true;; first = false) {
    auto at = weighted(scaled, unit, z, d, settings.weight_exponent, settings.order);
    if (!at) return give_up(at.error().text);
    if (!first) {
      auto plain = settings.weight_exponent == 1.0 ? Expected<Weighted>(*at) : weighted(scaled, unit, z, d, 1.0, settings.order);
      if (!plain) return give_up(plain.error().text);
      auto judgement = judged(scaled, plane, *plain, d);
      const double error = weighted_residual(data, judgement->response).norm() / norm;
      if (note(course, error)) {
        best = std::move(*judgement);
        best.poles = poles_of(plane, roots);
        best.reflected = reflected;
      }
      if (should_stop(course, settings.stop)) break;
    }
    auto step = next_denominator(scaled, *at, d, norm / scale);
    if (!step) return give_up(step.error().text);
    d = std::move(step->denominator);
    roots = std::move(step->roots);
    reflected = settings.stable ? reflect(roots, z, d) : 0;
    if (reflected > 0) {
      for (std::complex<double>& p : roots)
        if (std::abs(p) > 1.0) p = 1.0 / std::conj(p);
    }
  }
  if (course.best < 0) return give_up(course.reason);
  best.course = course;
  return best;
}

Eigen::VectorXd prewarp_candidates(const Eigen::VectorXd& omega, Eigen::Index count) {
  const double last = omega[omega.size() - 1];
  double first = omega[0];
  if (first == 0.0) first = omega.size() > 1 ? omega[1] : 1.0;
  if (!(last > 0.0)) return Eigen::VectorXd::Ones(1);
  Eigen::VectorXd a(count);
  for (Eigen::Index i = 0; i < count; ++i)
    a[i] = std::sqrt(first * last) *
           std::pow(10.0, static_cast<double>(i) / static_cast<double>(std::max<Eigen::Index>(count - 1, 1)));
  return a;
}

Expected<Fit> fit_with_scan(const Data& data, const FitSettings& settings) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  FitSettings brief = settings;
  brief.stop.iterations = std::min(settings.stop.iterations, kScanIterations);
  const Eigen::VectorXd candidates = prewarp_candidates(data.omega_rad_s);
  std::optional<double> chosen;
  double least = INFINITY;
  Expected<Fit> last = unexpected("no pre-warp frequency");
  for (const double a : candidates) {
    last = fit(data, Plane{a, 0.0}, brief);
    if (!last || !(last->error() < least)) continue;
    least = last->error();
    chosen = a;
  }
  if (!chosen) return last;
  return fit(data, Plane{*chosen, 0.0}, settings);
}

}  // namespace bodeflow::sanathanan_koerner
