#include "model_parameters.hpp"

namespace bodeflow::plants {
namespace {

Eigen::VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXcd roots(const Parameters& p, const char* name) {
  if (!p.has(name)) return {};
  const std::vector<std::complex<double>> values = p.complex_list(name);
  return Eigen::Map<const Eigen::VectorXcd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::MatrixXd matrix(const Parameters& p, const char* name) {
  if (!p.has(name)) return {};
  const Matrix m = p.matrix(name);
  Eigen::MatrixXd result(static_cast<Eigen::Index>(m.rows), static_cast<Eigen::Index>(m.columns));
  for (std::size_t i = 0; i < m.rows; ++i) {
    for (std::size_t j = 0; j < m.columns; ++j) result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = m(i, j);
  }
  return result;
}

bool any_of(const Parameters& p, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (p.has(name)) return true;
  }
  return false;
}

}  // namespace

void describe_model(Describe& d) {
  d.optional<std::vector<double>>("numerator").unit("").doc("coefficients in descending powers of s (or z)");
  d.optional<std::vector<double>>("denominator")
      .unit("")
      .doc("coefficients in descending powers of s (or z), of at least the numerator's degree");
  d.optional<std::vector<std::complex<double>>>("zeros").doc("rad/s (or values of z), complex ones with their conjugates");
  d.optional<std::vector<std::complex<double>>>("poles").doc("rad/s (or values of z), complex ones with their conjugates");
  d.optional<double>("gain").unit("").doc("factor of prod(s - zeros) / prod(s - poles); 1 where it is left out");
  d.optional<Matrix>("a").doc("dx/dt = A x + B u (or x[n+1]): states x states");
  d.optional<Matrix>("b").doc("states x inputs");
  d.optional<Matrix>("c").doc("y = C x + D u: outputs x states");
  d.optional<Matrix>("d").doc("outputs x inputs; zeros where it is left out");
  d.parameter("domain", "continuous")
      .choices({"continuous", "discrete"})
      .doc("discrete: the model is at the sample rate of its input");
}

bool given_by_matrices(const Parameters& p) { return any_of(p, {"a", "b", "c", "d"}); }

numerics::StateSpace read_model(const Parameters& p) {
  const double sample_time = p.text("domain") == "discrete" ? 1.0 : 0.0;
  const bool polynomials = any_of(p, {"numerator", "denominator"});
  const bool factors = any_of(p, {"zeros", "poles", "gain"});
  const bool matrices = given_by_matrices(p);
  if (polynomials + factors + matrices != 1) {
    fail(std::string("the model is given in ") + (polynomials || factors || matrices ? "more than one form" : "no form") +
         ", allowed: one of numerator and denominator; zeros, poles and gain; a, b, c and d");
  }
  if (polynomials) {
    if (!p.has("numerator") || !p.has("denominator")) fail("numerator and denominator are needed together");
    if (p.numbers("numerator").empty()) fail("numerator is empty, allowed: at least one coefficient");
    const numerics::TransferFunction system{vector(p.numbers("numerator")), vector(p.numbers("denominator")), sample_time};
    return value_or_fail(numerics::to_state_space(system));
  }
  if (factors) {
    const numerics::ZeroPoleGain system{roots(p, "zeros"), roots(p, "poles"), p.has("gain") ? p.number("gain") : 1.0,
                                        sample_time};
    return value_or_fail(numerics::to_state_space(system));
  }
  return value_or_fail(numerics::make_state_space(matrix(p, "a"), matrix(p, "b"), matrix(p, "c"), matrix(p, "d"), sample_time));
}

}  // namespace bodeflow::plants
