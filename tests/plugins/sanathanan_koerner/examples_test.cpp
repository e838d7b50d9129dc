// The examples of D. A. Jue (1998), synthesised to her Table 1: the acceptance figures A1 to A3 and A6.

#include "catch.hpp"
#include "sanathanan_koerner/fit.hpp"
#include "sanathanan_koerner/refinement.hpp"
#include "sanathanan_koerner/vector_fitting.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;

namespace {

/// Iterations until the error is at most `goal`.
int iterations_to(const Course& course, double goal) {
  for (std::size_t i = 0; i < course.errors.size(); ++i)
    if (course.errors[i] <= goal) return static_cast<int>(i) + 1;
  return 1000;
}

Eigen::VectorXcd with_conjugates(const Eigen::VectorXcd& above) {
  Eigen::VectorXcd all(2 * above.size());
  all << above, above.conjugate();
  return all;
}

struct Noisy {
  Data data;
  Eigen::MatrixXcd truth;
};

Noisy example_3(const char* file) {
  const auto rows = test::table_of(file);
  const auto lines = static_cast<Eigen::Index>(rows.size());
  Eigen::VectorXd omega(lines);
  Eigen::MatrixXcd truth(lines, 1), noisy(lines, 1);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const auto& row = rows[static_cast<std::size_t>(k)];
    omega[k] = row[0];
    truth(k, 0) = {row[1], row[2]};
    noisy(k, 0) = {row[3], row[4]};
  }
  return {test::data_of(omega, noisy), truth};
}

}  // namespace

TEST_CASE("example 2: 180 poles of six responses come out to rounding in few iterations", "[long]") {
  const Data data = test::example_2();
  const Eigen::VectorXcd truth = with_conjugates(test::modal_poles("ex2_system.csv"));
  const auto sk = fit(data, Plane{127.0, 0.0}, {180, 1.0, true, {}});
  REQUIRE(sk);
  CHECK(iterations_to(sk->course, 1e-12) <= 12);
  CHECK(sk->error() <= 1e-12);
  CHECK(sk->poles.real().maxCoeff() < 0.0);
  CHECK(sk->reflected == 0);
  CHECK(test::worst_match(sk->poles, truth) <= 1e-5);

  const auto vf = vector_fit(data, {180, Spacing::linear, true, {}});
  REQUIRE(vf);
  CHECK(iterations_to(vf->course, 1e-12) <= 8);
  CHECK(all_poles(vf->model.poles).real().maxCoeff() < 0.0);
  CHECK(test::worst_match(all_poles(vf->model.poles), truth) <= 1e-5);
}

TEST_CASE("example 2: fewer poles than modes leave the error that is expected", "[long]") {
  const Data data = test::example_2();
  const auto of = [&](Eigen::Index order) { return fit(data, Plane{127.0, 0.0}, {order, 1.0, true, {}}); };
  CHECK(of(118)->error() <= 1.3e-3);
  CHECK(of(58)->error() <= 0.065);
}

TEST_CASE("example 2: with noise of a thousandth the truth is nearer than the data", "[long]") {
  Data data = test::example_2();
  const Eigen::MatrixXcd truth = data.response;
  numerics::Random random(2);
  const double size = 1e-3 * truth.norm() / std::sqrt(static_cast<double>(truth.size()));
  for (std::complex<double>& g : data.response.reshaped())
    g += size * test::complex_normal(random) + 1e-5 * std::abs(g) * test::complex_normal(random);
  CHECK(test::relative_error(data.response, truth) == Approx(1e-3).epsilon(0.05));
  const auto sk = fit(data, Plane{127.0, 0.0}, {180, 1.0, true, {}});
  CHECK(test::relative_error(sk->response, truth) <= 6e-4);
  const auto vf = vector_fit(data, {180, Spacing::linear, true, {}});
  CHECK(test::relative_error(vf->response, truth) <= 6e-4);
}

TEST_CASE("example 1: 108 poles over three decades come out to rounding", "[long]") {
  const Data data = test::modal_data("ex1_system.csv", 1, 1, test::geometric(0.5, 2000.0, 1500));
  const auto sk = fit_with_scan(data, {108, 1.0, true, {}});
  REQUIRE(sk);
  CHECK(sk->error() <= 1e-12);
  const auto vf = vector_fit(data, {108, Spacing::linear, true, {}});
  REQUIRE(vf);
  CHECK(vf->error() <= 1e-12);
}

TEST_CASE("example 3: 120 poles of noisy data are nearer to the truth than the data", "[long]") {
  const Noisy single = example_3("ex3_frf_N1.csv"), averaged = example_3("ex3_frf_N3200.csv");
  CHECK(test::relative_error(fit_with_scan(single.data, {120, 1.0, true, {}})->response, single.truth) <= 9e-4);
  CHECK(test::relative_error(fit_with_scan(averaged.data, {120, 1.0, true, {}})->response, averaged.truth) <= 4e-5);
  CHECK(test::relative_error(vector_fit(single.data, {120, Spacing::linear, true, {40}})->response, single.truth) <= 9e-4);
  CHECK(test::relative_error(vector_fit(averaged.data, {120, Spacing::linear, true, {40}})->response, averaged.truth) <= 4e-5);
}
