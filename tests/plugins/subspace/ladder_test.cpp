// Transformer ladders of order 6, 17 and 31: 123 lines from 50 Hz to 200 kHz, exact and with 0.1 % noise.

#include "catch.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::subspace;
using test::Complex;

namespace {

struct Ladder {
  Lines exact, noisy;
  Eigen::VectorXcd poles;
};

Ladder ladder(int order) {
  const std::string name = "ladder" + std::to_string(order);
  const Eigen::MatrixXd rows = test::table(name + "_frf.csv"), poles = test::table(name + "_poles.csv");
  Ladder l;
  l.exact = {rows.col(0), Eigen::MatrixXcd(rows.rows(), 1), 1, Eigen::VectorXd::Ones(rows.rows())};
  l.noisy = l.exact;
  l.exact.response.real() = rows.col(1);
  l.exact.response.imag() = rows.col(2);
  l.noisy.response.real() = rows.col(3);
  l.noisy.response.imag() = rows.col(4);
  l.poles.resize(poles.rows());
  l.poles.real() = poles.col(0);
  l.poles.imag() = poles.col(1);
  return l;
}

Settings of_order(Eigen::Index order, int polish) {
  Settings s;
  s.order = order;
  s.functions = 40;
  s.polish = polish;
  return s;
}

double rms(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  return (a - b).norm() / std::sqrt(static_cast<double>(a.rows()));
}

}  // namespace

TEST_CASE("exact ladders are fitted to rounding in both bases") {
  for (const int order : {6, 17, 31}) {
    const Ladder l = ladder(order);
    const Plane plane{bandwidth_prewarp(l.exact.omega_rad_s), 0.0};
    for (const Basis basis : {Basis::arnoldi, Basis::powers}) {
      INFO("order " << order << ", powers: " << (basis == Basis::powers));
      Settings settings = of_order(order, 0);
      settings.basis = basis;
      const auto found = identify(l.exact, plane, settings);
      REQUIRE(found);
      CHECK(rms(found->model.response, l.exact.response) <= 1e-10 * l.exact.response.cwiseAbs().maxCoeff());
      CHECK(test::pole_error(found->model.poles, l.poles) < 1e-6);
    }
  }
}

TEST_CASE("noisy ladders are fitted within the noise of the truth, and polishing brings them nearer") {
  const double subspace_alone[] = {1.1e-3, 4e-7, 1.5e-6}, after_polish[] = {1.1e-3, 3e-7, 1.1e-6};
  const int orders[] = {6, 17, 31};
  for (std::size_t i = 0; i < 3; ++i) {
    INFO("order " << orders[i]);
    const Ladder l = ladder(orders[i]);
    const Plane plane{bandwidth_prewarp(l.noisy.omega_rad_s), 0.0};
    const auto alone = identify(l.noisy, plane, of_order(orders[i], 0)),
               better = identify(l.noisy, plane, of_order(orders[i], 5));
    REQUIRE(alone);
    REQUIRE(better);
    CHECK(rms(alone->model.response, l.exact.response) <= subspace_alone[i]);
    CHECK(rms(better->model.response, l.exact.response) <= after_polish[i]);
    CHECK(better->model.unstable == 0);
    CHECK(better->quality.weighted <= better->unpolished.weighted);
  }
}

TEST_CASE("weights of relative errors find what is small in a ladder") {
  const Ladder l = ladder(6);
  Lines lines = l.noisy;
  lines.weight = relative_weights(lines).value();
  const auto found = identify(lines, {bandwidth_prewarp(lines.omega_rad_s), 0.0}, of_order(6, 5));
  REQUIRE(found);
  const double relative = ((found->model.response - l.exact.response).cwiseQuotient(l.exact.response)).norm() /
                          std::sqrt(static_cast<double>(lines.size()));
  CHECK(relative < 4e-4);
}

TEST_CASE("the order of a noisy ladder is found on a repeated measurement") {
  const Ladder l = ladder(6);
  numerics::Random random(23);
  Lines repeated = l.exact;
  for (Complex& g : repeated.response.reshaped()) g *= 1.0 + 1e-3 * Complex(random.normal(), random.normal()) / std::sqrt(2.0);
  Settings settings;
  settings.highest_order = 20;
  const auto found = identify(l.noisy, {bandwidth_prewarp(l.noisy.omega_rad_s), 0.0}, settings, repeated);
  REQUIRE(found);
  REQUIRE(found->scan);
  CHECK(found->model.order() >= 6);
  CHECK(found->model.order() <= 8);
  CHECK(found->scan->orders.size() == 20);
}
