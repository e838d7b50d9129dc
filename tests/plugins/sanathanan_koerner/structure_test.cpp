// Realisation, columns, planes, order, covariance of small systems.

#include <bodeflow/numerics/frequency_response.hpp>
#include <numbers>

#include "catch.hpp"
#include "sanathanan_koerner/identification.hpp"
#include "sanathanan_koerner/model_record.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;

namespace {

/// 2 outputs x 3 inputs with 3 modes.
Data small_matrix() {
  Data d = test::data_of(test::geometric(1.0, 50.0, 80), Eigen::MatrixXcd::Zero(80, 6));
  numerics::Random random(5);
  for (const double wn : {3.0, 8.0, 21.0}) {
    const Eigen::Vector2d c(random.normal(), random.normal());
    const Eigen::RowVector3d b(random.normal(), random.normal(), random.normal());
    for (Eigen::Index k = 0; k < 80; ++k) {
      const double w = d.omega_rad_s[k];
      const Eigen::MatrixXcd g = (c * b) * (wn * wn / std::complex<double>(wn * wn - w * w, 0.04 * wn * w));
      d.response.row(k) += g.reshaped().transpose();
    }
  }
  return d;
}

Eigen::MatrixXcd response_of(const numerics::StateSpace& system, const Eigen::VectorXd& omega) {
  const auto at = numerics::frequency_response(system, omega / (2.0 * std::numbers::pi));
  Eigen::MatrixXcd g(omega.size(), system.outputs() * system.inputs());
  for (Eigen::Index k = 0; k < g.rows(); ++k) g.row(k) = at[static_cast<std::size_t>(k)].reshaped().transpose();
  return g;
}

Settings of_order(Eigen::Index order, Method method = Method::arnoldi) {
  Settings s;
  s.order = order;
  s.method = method;
  return s;
}

}  // namespace

TEST_CASE("realisation: the state space of stacked columns has the response of the data") {
  const Data data = small_matrix();
  for (const Method method : {Method::arnoldi, Method::vector_fitting, Method::monomial}) {
    const auto found = identify(data, of_order(6, method), 3);
    REQUIRE(found);
    CHECK(found->error() < 1e-10);
    const auto matrix = reshaped(found->system, 3);
    CHECK(matrix.inputs() == 3);
    CHECK(matrix.outputs() == 2);
    CHECK(matrix.states() == 12);  // order times the smaller of inputs and outputs
    CHECK(test::relative_error(response_of(matrix, data.omega_rad_s), data.response) < 1e-10);
    const auto tall = reshaped(found->system, 2);
    CHECK(test::relative_error(response_of(tall, data.omega_rad_s), data.response) < 1e-10);
    const auto row = reshaped(found->system, 6);
    CHECK(row.states() == 6);  // several inputs and one output: the transposed of one input
    CHECK(test::relative_error(response_of(row, data.omega_rad_s), data.response) < 1e-10);
  }
}

TEST_CASE("columns: the denominator of the strongest input serves the others") {
  const Data data = small_matrix();
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    Settings s = of_order(6, method);
    s.columns = Columns::by_column;
    const auto found = identify(data, s, 3);
    REQUIRE(found);
    CHECK(found->error() < 1e-9);
    CHECK(test::relative_error(response_of(reshaped(found->system, 3), data.omega_rad_s), data.response) < 1e-9);
  }
}

TEST_CASE("columns: weights of their own for each response give the same exact model") {
  Data data = small_matrix();
  data.weights = data.response.cwiseAbs().cwiseInverse();
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    const auto found = identify(data, of_order(6, method), 3);
    REQUIRE(found);
    CHECK(test::relative_error(found->response, data.response) < 1e-10);
  }
}

TEST_CASE("plane: a sampled system comes back in z") {
  const numerics::TransferFunction truth{Eigen::Vector3d(0.0, 1.0, 0.5), Eigen::Vector3d(1.0, -1.5, 0.9), 0.01};
  Data data = test::data_of(2.0 * std::numbers::pi * Eigen::VectorXd::LinSpaced(40, 1.0, 49.0), {});
  data.response = numerics::frequency_response(truth, data.omega_rad_s / (2.0 * std::numbers::pi));
  Settings s = of_order(2);
  s.sample_time_s = 0.01;
  const auto found = identify(data, s);
  REQUIRE(found);
  CHECK(found->system.sample_time == 0.01);
  CHECK(test::relative_error(response_of(found->system, data.omega_rad_s), data.response) < 1e-12);
  CHECK(std::norm(found->poles[0]) == Approx(0.9));
}

TEST_CASE("stability: an unstable plant is reflected or left as it is wished") {
  const numerics::TransferFunction truth{Eigen::VectorXd::Constant(1, 5.0), Eigen::Vector3d(1.0, -0.4, 9.0), 0.0};
  Data data = test::data_of(test::geometric(0.5, 20.0, 60), {});
  data.response = numerics::frequency_response(truth, data.omega_rad_s / (2.0 * std::numbers::pi));
  for (const Method method : {Method::arnoldi, Method::vector_fitting}) {
    Settings s = of_order(2, method);
    s.stable = false;
    const auto free = identify(data, s);
    REQUIRE(free);
    CHECK(free->error() < 1e-12);
    CHECK(free->poles.real().minCoeff() == Approx(0.2));
    s.stable = true;
    const auto stable = identify(data, s);
    REQUIRE(stable);
    CHECK(stable->poles.real().maxCoeff() <= 0.0);
  }
}

TEST_CASE("order: the one of the plant is proposed with the evidence") {
  Data data = small_matrix();
  const Eigen::MatrixXcd truth = data.response;
  numerics::Random random(11);
  const auto noisy = [&] {
    Data d = data;
    d.response = truth + 0.01 * Eigen::MatrixXcd::NullaryExpr(80, 6, [&] { return test::complex_normal(random); });
    return d;
  };
  const Data first = noisy(), again = noisy();
  Settings s;
  s.highest_order = 9;
  for (const bool repeated : {false, true}) {
    const auto found = identify(first, s, 3, repeated ? std::optional(again) : std::nullopt);
    REQUIRE(found);
    REQUIRE(found->scan);
    CHECK(found->order == 6);
    CHECK(found->scan->orders.size() == 9);
    CHECK_FALSE(found->scan->still_falls);
    CHECK(found->scan->reason.find(repeated ? "repeated" : "the minimum of MDL") != std::string::npos);
    CHECK(found->scan->orders[5].odd_even.value() < 0.05);
  }
  const auto exact = identify(data, s, 3);
  CHECK(exact->order == 6);
}

TEST_CASE("polynomials: given where they reproduce the response and left out where they do not") {
  const numerics::TransferFunction truth{Eigen::Vector2d(2.0, 7.0), Eigen::Vector4d(1.0, 0.6, 9.0, 2.0), 0.0};
  Data data = test::data_of(test::geometric(0.1, 20.0, 50), {});
  data.response = numerics::frequency_response(truth, data.omega_rad_s / (2.0 * std::numbers::pi));
  const auto found = identify(data, of_order(3));
  REQUIRE(found);
  const auto tf = faithful_polynomials(found->system, found->poles, data.omega_rad_s, found->response);
  REQUIRE(tf);
  CHECK((tf->denominator - truth.denominator).cwiseAbs().maxCoeff() < 1e-8);
  CHECK(std::abs(tf->numerator[2] - 2.0) < 1e-7);

  const Data wide = test::modal_data("ex1_system.csv", 1, 1, test::geometric(0.5, 2000.0, 400));
  const auto high = identify(wide, of_order(100));
  REQUIRE(high);
  CHECK_FALSE(faithful_polynomials(high->system, high->poles, wide.omega_rad_s, high->response));
}
