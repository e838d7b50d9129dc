// The transformer ladders of H. Akcay, S. M. Islam, B. Ninness in kind: exact and with 0.1 % noise.

#include "catch.hpp"
#include "sanathanan_koerner/fit.hpp"
#include "sanathanan_koerner/refinement.hpp"
#include "sanathanan_koerner/vector_fitting.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;

namespace {

struct Ladder {
  Data exact, noisy;
};

Ladder ladder(int order) {
  const auto rows = test::table_of("ladder" + std::to_string(order) + "_frf.csv");
  const auto lines = static_cast<Eigen::Index>(rows.size());
  Eigen::VectorXd omega(lines);
  Eigen::MatrixXcd exact(lines, 1), noisy(lines, 1);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const auto& row = rows[static_cast<std::size_t>(k)];
    omega[k] = row[0];
    exact(k, 0) = {row[1], row[2]};
    noisy(k, 0) = {row[3], row[4]};
  }
  return {test::data_of(omega, exact), test::data_of(omega, noisy)};
}

double rms(const Eigen::MatrixXcd& found, const Eigen::MatrixXcd& truth) {
  return (found - truth).norm() / std::sqrt(static_cast<double>(truth.size()));
}

Eigen::VectorXcd poles_of_ladder(int order) {
  const auto rows = test::table_of("ladder" + std::to_string(order) + "_poles.csv");
  Eigen::VectorXcd poles(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t n = 0; n < rows.size(); ++n) poles[static_cast<Eigen::Index>(n)] = {rows[n][0], rows[n][1]};
  return poles;
}

}  // namespace

TEST_CASE("ladders: data without noise come out to rounding over seven decades") {
  for (const int order : {6, 17, 31}) {
    INFO("order " << order);
    const Ladder l = ladder(order);
    const double greatest = l.exact.response.cwiseAbs().maxCoeff();
    const auto sk = fit_with_scan(l.exact, {order, 1.0, true, {}});
    REQUIRE(sk);
    CHECK(rms(sk->response, l.exact.response) <= 1e-10 * greatest);
    CHECK(test::worst_match(sk->poles, poles_of_ladder(order)) < 1e-5);
    const auto vf = vector_fit(l.exact, {order, Spacing::linear, true, {40}});
    REQUIRE(vf);
    CHECK(rms(vf->response, l.exact.response) <= 1e-10 * greatest);
  }
}

TEST_CASE("ladders: with noise the models are as near to the truth as those of the prototype") {
  for (const auto& [order, limit] : {std::pair(6, 1.1e-3), std::pair(17, 3e-7), std::pair(31, 1.1e-6)}) {
    INFO("order " << order);
    const Ladder l = ladder(order);
    const auto sk = fit_with_scan(l.noisy, {order, 1.0, true, {}});
    REQUIRE(sk);
    CHECK(rms(sk->response, l.exact.response) <= limit);
    const auto vf = vector_fit(l.noisy, {order, Spacing::linear, true, {40}});
    REQUIRE(vf);
    CHECK(rms(vf->response, l.exact.response) <= limit);
  }
}

TEST_CASE("ladders: weights by 1/|G| keep the relative error small everywhere") {
  for (const auto& [order, limit] : {std::pair(6, 3e-4), std::pair(17, 5.5e-4), std::pair(31, 7e-4)}) {
    INFO("order " << order);
    Ladder l = ladder(order);
    l.noisy.weights = l.noisy.response.cwiseAbs().cwiseInverse();
    const auto sk = fit_with_scan(l.noisy, {order, 1.0, true, {}});
    REQUIRE(sk);
    const Eigen::MatrixXcd relative = (sk->response - l.exact.response).cwiseQuotient(l.exact.response);
    CHECK(relative.norm() / std::sqrt(123.0) <= limit);
  }
}

TEST_CASE("refinement: nonlinear least squares fits noisy ladders better than the iteration's fixed point") {
  for (const int order : {6, 17, 31}) {
    INFO("order " << order);
    const Ladder l = ladder(order);
    const auto sk = fit_with_scan(l.noisy, {order, 1.0, true, {}});
    REQUIRE(sk);
    const auto better = refined(l.noisy, *sk, {});
    REQUIRE(better);
    CHECK(better->error() <= sk->error());
    CHECK(better->course.converged);
    CHECK(better->poles.real().maxCoeff() <= 0.0);
  }
}

TEST_CASE("several starts: the best few go on and end as low as the best start alone") {
  for (const int order : {17, 31}) {
    const Data data = ladder(order).noisy;
    double best = INFINITY;
    for (const double a : prewarp_candidates(data.omega_rad_s)) {
      const auto alone = fit(data, Plane{a, 0.0}, {order, 1.0, true, {}});
      REQUIRE(alone);
      best = std::min(best, alone->error());
    }
    CHECK(fit_with_scan(data, {order, 1.0, true, {}})->error() <= 1.05 * best);
    const auto one = vector_fit(data, {order, Spacing::linear, true, {}}),
               several = vector_fit(data, {order, Spacing::automatic, true, {}});
    REQUIRE(one);
    REQUIRE(several);
    CHECK(several->error() <= 1.05 * one->error());
  }
}
