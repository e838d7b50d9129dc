#include "line_response.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>

namespace bodeflow::spectrum {
namespace {

// A larger condition number is rounding: the spectra themselves are good to about 1e-14.
constexpr double kSingular = 1e12;

struct Inverse {
  Eigen::MatrixXcd matrix;  // right inverse: columns x rows
  double condition = 1.0;
};

/// A^H (A A^H)^-1 of a matrix with at most as many rows as columns. Rows are scaled to the same size before their condition is
/// judged: units do not matter.
Expected<Inverse> right_inverse(const Eigen::MatrixXcd& a, Eigen::Index k, const char* what) {
  const std::string line = "line " + std::to_string(k) + ": ";
  if (a.size() == 1) return Inverse{Eigen::MatrixXcd::Constant(1, 1, 1.0 / a(0, 0)), 1.0};
  const Eigen::VectorXd scale = a.rowwise().norm();
  Eigen::Index silent = 0;
  if (!(scale.minCoeff(&silent) > 0.0)) {
    return unexpected(line + what + " " + std::to_string(silent + 1) + " is zero in all experiments");
  }
  const Eigen::MatrixXcd scaled = scale.cwiseInverse().asDiagonal() * a;
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd s = svd.singularValues();
  if (!(s[s.size() - 1] * kSingular > s[0])) {
    return unexpected(line + "the experiments do not drive the " + what +
                      "s independently of each other; needed: as many experiments as " + what +
                      "s, with orthogonal or different excitations");
  }
  const Eigen::MatrixXcd inverse = svd.matrixV() * s.cwiseInverse().asDiagonal() * svd.matrixU().adjoint();
  return Inverse{inverse * scale.cwiseInverse().asDiagonal(), s[0] / s[s.size() - 1]};
}

}  // namespace

Eigen::MatrixXcd spectra_at(const Measured& measured, std::size_t realisation, Eigen::Index k) {
  Eigen::MatrixXcd z(measured.layout.signals(), measured.experiments);
  for (Eigen::Index e = 0; e < measured.experiments; ++e) z.col(e) = measured.part(realisation, e).mean.row(k).transpose();
  return z;
}

Expected<FromReference> from_reference(const Measured& measured, std::size_t realisation, Eigen::Index k) {
  const Eigen::MatrixXcd z = spectra_at(measured, realisation, k);
  auto inverse = right_inverse(z.bottomRows(measured.layout.references), k, "reference");
  if (!inverse) return unexpected(inverse.error().text);
  return FromReference{z * inverse->matrix, inverse->matrix, inverse->condition};
}

Expected<LineResponse> line_response(const Measured& measured, std::size_t realisation, Eigen::Index k, Form form) {
  const Layout& l = measured.layout;
  const Eigen::MatrixXcd z = spectra_at(measured, realisation, k);
  Eigen::MatrixXcd before = Eigen::MatrixXcd::Identity(measured.experiments, measured.experiments);
  double condition = 1.0;
  if (form == Form::reference) {
    auto reference = from_reference(measured, realisation, k);
    if (!reference) return unexpected(reference.error().text);
    before = reference->weights;
    condition = reference->condition;
  }
  auto inverse = right_inverse(z.topRows(l.inputs) * before, k, "input");
  if (!inverse) return unexpected(inverse.error().text);
  LineResponse at;
  at.weights = before * inverse->matrix;
  at.condition = std::max(condition, inverse->condition);
  at.response = z.middleRows(l.inputs, l.outputs) * at.weights;
  add_variance(at, measured, realisation, k, form);
  return at;
}

void add_variance(LineResponse& at, const Measured& measured, std::size_t realisation, Eigen::Index k, Form form) {
  const Layout& l = measured.layout;
  if (!measured.has_noise()) return;
  const Eigen::MatrixXd squares = at.weights.cwiseAbs2();  // experiments x inputs
  at.variance = Eigen::MatrixXd::Zero(l.outputs, l.inputs);
  Eigen::RowVectorXd shares = Eigen::RowVectorXd::Zero(l.inputs);
  for (Eigen::Index e = 0; e < measured.experiments; ++e) {
    const Moments& m = measured.part(realisation, e);
    const Eigen::MatrixXcd c = covariance_at(m, k);
    for (Eigen::Index i = 0; i < l.outputs; ++i) {
      Eigen::RowVectorXcd row = Eigen::RowVectorXcd::Zero(l.inputs + 1);
      if (form != Form::known_input) row.head(l.inputs) = -at.response.row(i);
      row[l.inputs] = 1.0;
      Eigen::MatrixXcd joint(l.inputs + 1, l.inputs + 1);
      joint.topLeftCorner(l.inputs, l.inputs) = c.topLeftCorner(l.inputs, l.inputs);
      joint.col(l.inputs).head(l.inputs) = c.col(l.inputs + i).head(l.inputs);
      joint.row(l.inputs).head(l.inputs) = c.row(l.inputs + i).head(l.inputs);
      joint(l.inputs, l.inputs) = c(l.inputs + i, l.inputs + i);
      const double noise = (row * joint * row.adjoint())(0, 0).real();
      at.variance.row(i) += std::max(0.0, noise) * squares.row(e);  // below zero by rounding alone
      if (std::isnan(noise)) at.variance.row(i).setConstant(noise);
    }
    shares += squares.row(e).cwiseAbs2() / m.degrees_of_freedom;
  }
  const Eigen::RowVectorXd sums = squares.colwise().sum();
  at.degrees_of_freedom = sums.cwiseAbs2().cwiseQuotient(shares).replicate(l.outputs, 1);
}

}  // namespace bodeflow::spectrum
