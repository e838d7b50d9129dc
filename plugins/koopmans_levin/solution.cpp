#include "solution.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <complex>

#include "powers.hpp"

namespace bodeflow::koopmans_levin {

namespace {

// Two singular values this far below the greatest cannot be told apart from rounding: more than one model fits.
constexpr double kRounding = 1e-13;
// A leading coefficient of A this small beside the whole vector is rounding.
constexpr double kLeastLeading = 1e-12;

// C with C^T C = Lambda.
Eigen::MatrixXd noise_root(const Factors& f, double ratio, NoiseMatrix which) {
  const Eigen::Index powers = f.order + 1;
  const Eigen::MatrixXd part = which == NoiseMatrix::exact ? f.noise : Eigen::MatrixXd::Identity(powers, powers);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(2 * powers, 2 * powers);
  c.topLeftCorner(powers, powers) = std::sqrt(ratio) * part;
  c.bottomRightCorner(powers, powers) = part;
  return c;
}

void fill_model(const Factors& f, Solution& s) {
  const Eigen::Index n = f.order;
  s.a = s.x.head(n + 1).reverse();
  s.b = -s.x.tail(n + 1).reverse();
  if (f.has_transient()) {
    s.tau = f.transient.triangularView<Eigen::Upper>().solve(f.coupling * s.x).reverse();
  }
  s.noise_unbiased = s.noise / (1.0 - double(f.free_parameters) / double(f.equations));
}

}  // namespace

Expected<Solution> solve(const Factors& f, double ratio, NoiseMatrix noise_matrix) {
  if (!(ratio > 0.0) || !std::isfinite(ratio)) return refused("the noise ratio must be above 0 and finite");
  const Eigen::MatrixXd c = noise_root(f, ratio, noise_matrix);
  const Eigen::MatrixXd m = c.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(f.data);
  if (!m.allFinite()) return refused("the band is too narrow for order " + std::to_string(f.order));
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(m, Eigen::ComputeFullV);
  const Eigen::VectorXd& singular = svd.singularValues();
  const Eigen::Index q = singular.size();
  if (!(singular[q - 2] > kRounding * singular[0])) {
    return refused("the data leave more than one model of order " + std::to_string(f.order) +
                   ": lower the order, or excite more lines of the band");
  }
  Solution s;
  s.ratio = ratio;
  s.noise_matrix = noise_matrix;
  s.squares = singular.cwiseAbs2();
  s.noise = s.squares[q - 1];
  s.basis = c.triangularView<Eigen::Upper>().solve(svd.matrixV());
  s.x = s.basis.col(q - 1);
  if (!(std::abs(s.x[f.order]) > kLeastLeading * s.x.norm())) {
    return refused("the model of order " + std::to_string(f.order) + " has no term of the present output");
  }
  s.x /= s.x[f.order];
  fill_model(f, s);
  return s;
}

std::vector<std::string> parameter_names(Eigen::Index order) {
  std::vector<std::string> names;
  for (Eigen::Index i = 1; i <= order; ++i) names.push_back("a" + std::to_string(i));
  for (Eigen::Index i = 0; i <= order; ++i) names.push_back("b" + std::to_string(i));
  return names;
}

Eigen::VectorXd parameters(const Model& model) {
  Eigen::VectorXd p(2 * model.order() + 1);
  p << model.a.tail(model.order()), model.b;
  return p;
}

Eigen::VectorXcd response(const Model& model, const Eigen::VectorXd& omega) {
  Eigen::VectorXcd g(omega.size());
  for (Eigen::Index i = 0; i < omega.size(); ++i) {
    const std::complex<double> z = std::polar(1.0, -omega[i]);
    g[i] = ascending(model.b, z) / ascending(model.a, z);
  }
  return g;
}

Eigen::VectorXcd equation_errors(const Lines& lines, const Model& model) {
  Eigen::VectorXcd errors(lines.size());
  for (Eigen::Index i = 0; i < lines.size(); ++i) {
    const std::complex<double> z = std::polar(1.0, -lines.omega(i));
    errors[i] = ascending(model.a, z) * lines.output[i] - ascending(model.b, z) * lines.input[i] - ascending(model.tau, z);
  }
  return errors;
}

Eigen::VectorXd equation_variances(const Lines& lines, const Model& model) {
  Eigen::VectorXd variances(lines.size());
  for (Eigen::Index i = 0; i < lines.size(); ++i) {
    const std::complex<double> z = std::polar(1.0, -lines.omega(i));
    variances[i] = model.noise * (model.ratio * std::norm(ascending(model.a, z)) + std::norm(ascending(model.b, z)));
  }
  return variances;
}

}  // namespace bodeflow::koopmans_levin
