// What data can do to the methods: a right answer or a clear refusal.

#include <limits>

#include "catch.hpp"
#include "sanathanan_koerner/identification.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;

namespace {

const Eigen::VectorXd kOmega = test::geometric(1.0, 10.0, 20);

Data one_mode() {
  Data d = test::data_of(kOmega, Eigen::MatrixXcd(20, 1));
  for (Eigen::Index k = 0; k < 20; ++k) {
    const std::complex<double> s(0.0, kOmega[k]);
    d.response(k, 0) = 9.0 / (s * s + 0.2 * s + 9.0);
  }
  return d;
}

template <class Change>
std::string reason(Change change, Eigen::Index order = 2, Method method = Method::arnoldi) {
  Data d = one_mode();
  change(d);
  Settings s;
  s.order = order;
  s.method = method;
  const auto found = identify(d, s);
  return found ? "a model" : found.error().text;
}

}  // namespace

TEST_CASE("refusal: bad data are refused by name by all methods") {
  for (const Method method : {Method::arnoldi, Method::vector_fitting, Method::monomial}) {
    const auto of = [&](auto change) { return reason(change, 2, method); };
    CHECK(of([](Data&) {}) == "a model");
    CHECK(of([](Data& d) { d.response(4, 0) = NAN; }) == "the response is not finite at line 5");
    CHECK(of([](Data& d) { d.response(0, 0) = {0.0, INFINITY}; }) == "the response is not finite at line 1");
    CHECK(of([](Data& d) { d.response.setZero(); }) == "the response is zero at all lines: there is nothing to fit");
    CHECK(of([](Data& d) { d.omega_rad_s[3] = d.omega_rad_s[2]; }) == "the frequency of line 4 repeats that of the line before");
    CHECK(of([](Data& d) { std::swap(d.omega_rad_s[3], d.omega_rad_s[2]); }) ==
          "the frequency of line 4 is below that of the line before; needed: frequencies that rise");
    CHECK(of([](Data& d) { d.omega_rad_s[0] = -1.0; }) == "the frequency of line 1 is below 0");
    CHECK(of([](Data& d) { d.omega_rad_s[19] = NAN; }) == "the frequency of line 20 is not finite");
    CHECK(of([](Data& d) { d.weights(2, 0) = -1.0; }) == "the weight of line 3 is below 0 or not finite");
    CHECK(of([](Data& d) { d.weights.setZero(); }) == "the weights are zero wherever the response is not");
    CHECK(of([](Data& d) { d.response *= 1e200; }) == "the response is too large to be squared");
    CHECK(of([](Data& d) { d.response.resize(3, 1); }) == "frequencies, response and weights differ in size");
  }
}

TEST_CASE("refusal: an order that the lines can't determine is refused with the number needed") {
  for (const Method method : {Method::arnoldi, Method::vector_fitting, Method::monomial})
    CHECK(reason([](Data&) {}, 30, method) == "order 30 with 1 response needs at least 31 lines; there are 20");
  const auto few = [](Data& d) { d.weights.bottomRows(18).setZero(); };
  CHECK(reason(few, 2) == "order 2 with 1 response needs at least 3 lines; there are 2");
}

TEST_CASE("robustness: a gain needs no poles and a constant response has none to find") {
  Data d = one_mode();
  d.response.setConstant(3.0);
  Settings s;
  s.order = 0;
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    s.method = method;
    const auto found = identify(d, s);
    REQUIRE(found);
    CHECK(found->system.states() == 0);
    CHECK(found->system.D(0, 0) == Approx(3.0));
  }
}

TEST_CASE("robustness: more poles than the plant has are no harm to the response") {
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    Settings s;
    s.order = 8;
    s.method = method;
    const auto found = identify(one_mode(), s);
    REQUIRE(found);
    CHECK(found->error() < 1e-8);
    CHECK(found->poles.real().maxCoeff() <= 0.0);
  }
}

TEST_CASE("robustness: eight decades of dynamic range are fitted to each line's own size with relative weights") {
  Data d = test::data_of(test::geometric(1.0, 1e4, 200), Eigen::MatrixXcd(200, 1));
  for (Eigen::Index k = 0; k < 200; ++k) {
    const std::complex<double> s(0.0, d.omega_rad_s[k]);
    d.response(k, 0) = 1e5 / ((s * s + 0.2 * s + 25.0) * (s + 300.0));
  }
  REQUIRE(d.response.cwiseAbs().maxCoeff() / d.response.cwiseAbs().minCoeff() > 1e8);
  d.weights = d.response.cwiseAbs().cwiseInverse();
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    Settings s;
    s.order = 3;
    s.method = method;
    const auto found = identify(d, s);
    REQUIRE(found);
    CHECK((found->response - d.response).cwiseQuotient(d.response).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("robustness: a narrow band at 75 to 110 GHz comes out to rounding") {
  const double scale = 2e9 * 3.14159265358979;
  Data d = test::data_of(scale * Eigen::VectorXd::LinSpaced(101, 75.0, 110.0), Eigen::MatrixXcd::Zero(101, 1));
  for (const double f : {80.0, 92.0, 101.0}) {
    const std::complex<double> p = scale * std::complex<double>(-0.7, f);
    for (Eigen::Index k = 0; k < 101; ++k) {
      const std::complex<double> s(0.0, d.omega_rad_s[k]);
      d.response(k, 0) += scale * (1.0 / (s - p) + 1.0 / (s - std::conj(p)));
    }
  }
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    Settings s;
    s.order = 6;
    s.method = method;
    const auto found = identify(d, s);
    REQUIRE(found);
    CHECK(found->error() < 1e-10);
  }
}

TEST_CASE("robustness: a line at zero frequency is a line like others") {
  Data d = one_mode();
  d.omega_rad_s[0] = 0.0;
  d.response(0, 0) = 1.0;
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    Settings s;
    s.order = 2;
    s.method = method;
    const auto found = identify(d, s);
    REQUIRE(found);
    CHECK(found->error() < 1e-12);
  }
}
