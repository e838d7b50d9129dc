#include "iteration.hpp"

#include <Eigen/QR>
#include <cmath>

#include "elimination.hpp"
#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {

/// The data in the weights of one iterate: basis with w = q / |d|^e and the numerators' part.
struct Iteration::Weighted {
  Eigen::VectorXd w;
  Basis basis;
  Elimination elimination;
};

namespace {

using Weighted = Iteration::Weighted;

Expected<Weighted> weighted(const Data& data, const Eigen::VectorXd& q, const Eigen::VectorXcd& z, const Eigen::VectorXcd& d,
                            double exponent, Eigen::Index order) {
  const Eigen::VectorXd size = d.cwiseAbs();
  Eigen::VectorXd w = exponent == 1.0 ? q.cwiseQuotient(size) : Eigen::VectorXd(q.array() / size.array().pow(exponent));
  auto basis = arnoldi(z, w, order);
  if (!basis) return unexpected(basis.error().text);
  Elimination elimination(data, q, basis->vectors, true);
  return Weighted{std::move(w), std::move(*basis), std::move(elimination)};
}

/// The model with denominator d in a basis of weight q/|d|.
Fit judged(const Data& data, const Plane& plane, const Weighted& at, const Eigen::VectorXcd& d) {
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
  Fit f = judged(data, plane, *at, denominator);
  auto roots = roots_of(f.model.hessenberg, f.model.denominator);
  if (!roots) return unexpected(roots.error().text);
  f.poles = poles_of(plane, *roots);
  note(f.course, weighted_residual(data, f.response).norm() / weighted_norm(data));
  return f;
}

ScaledData scaled_data(const Data& data) {
  const Eigen::VectorXd q = shared_weights(data);
  const double scale = q.norm() / std::sqrt(static_cast<double>(data.lines()));
  ScaledData s{data, q / scale, 0.0};
  s.data.weights /= scale;
  s.norm = weighted_norm(s.data);
  return s;
}

Iteration::Iteration(const ScaledData& data, const Plane& plane, const FitSettings& settings, const Eigen::VectorXcd& start)
    : data_(&data), plane_(plane), settings_(settings), z_(plane.circle(data.data.omega_rad_s)) {
  denominator_ = start.size() > 0 ? start : Eigen::VectorXcd::Ones(z_.size());
}

Iteration::Iteration(Iteration&&) noexcept = default;
Iteration& Iteration::operator=(Iteration&&) noexcept = default;
Iteration::~Iteration() = default;

bool Iteration::end(const std::string& why) {
  course_.reason = why;
  return false;
}

bool Iteration::advance() {
  if (!course_.reason.empty()) return false;
  const Data& data = data_->data;
  if (!weighted_) {
    auto first = weighted(data, data_->shared, z_, denominator_, settings_.weight_exponent, settings_.order);
    if (!first) return end(first.error().text);
    weighted_ = std::make_unique<Weighted>(std::move(*first));
  }
  auto step = next_denominator(data, *weighted_, denominator_, data_->norm);
  if (!step) return end(step.error().text);
  denominator_ = std::move(step->denominator);
  const Eigen::Index reflected = settings_.stable ? reflect(step->roots, z_, denominator_) : 0;
  if (reflected > 0) {
    for (std::complex<double>& p : step->roots)
      if (std::abs(p) > 1.0) p = 1.0 / std::conj(p);
  }
  auto at = weighted(data, data_->shared, z_, denominator_, 1.0, settings_.order);
  if (!at) return end(at.error().text);
  Fit judgement = judged(data, plane_, *at, denominator_);
  if (note(course_, weighted_residual(data, judgement.response).norm() / data_->norm)) {
    best_ = std::move(judgement);
    best_.poles = poles_of(plane_, step->roots);
    best_.reflected = reflected;
  }
  if (should_stop(course_, settings_.stop)) return false;
  weighted_.reset();
  if (settings_.weight_exponent == 1.0) weighted_ = std::make_unique<Weighted>(std::move(*at));
  return true;
}

Expected<Fit> Iteration::result() && {
  if (course_.best < 0) return unexpected("no model of order " + std::to_string(settings_.order) + ": " + course_.reason);
  best_.course = std::move(course_);
  return std::move(best_);
}

}  // namespace bodeflow::sanathanan_koerner
