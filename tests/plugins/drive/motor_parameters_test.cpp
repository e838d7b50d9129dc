#include "drive/motor_parameters.hpp"

#include <initializer_list>

#include "catch.hpp"

using namespace bodeflow::drive;

namespace {

constexpr MotorParameters kPaper{6.6, 5.5, 0.475, 0.475, 0.454};
constexpr MotorParameters kUnequal{1.3, 0.9, 0.21, 0.19, 0.18};

void check_same(const MotorParameters& a, const MotorParameters& b) {
  CHECK(a.rs == Approx(b.rs).epsilon(1e-12));
  CHECK(a.rr == Approx(b.rr).epsilon(1e-12));
  CHECK(a.ls == Approx(b.ls).epsilon(1e-12));
  CHECK(a.lr == Approx(b.lr).epsilon(1e-12));
  CHECK(a.lm == Approx(b.lm).epsilon(1e-12));
}

}  // namespace

TEST_CASE("motor parameters: the paper's Table 1 has the paper's constants") {
  const ModelConstants c = constants_of(kPaper);
  CHECK(c.gamma == Approx(283.02866962886264).epsilon(1e-13));
  CHECK(c.alpha == Approx(11.578947368421053).epsilon(1e-13));
  CHECK(c.lm_beta == Approx(10.565175047414028).epsilon(1e-13));
  CHECK(c.sigma == Approx(0.04107157894736837).epsilon(1e-13));
  CHECK(c.beta == Approx(23.271).epsilon(1e-4));
  CHECK(torque_constant(kPaper) == Approx(1.4336842105).epsilon(1e-9));
}

TEST_CASE("motor parameters: each form gives the motor back") {
  for (const MotorParameters& p : {kPaper, kUnequal}) {
    check_same(*from_constants(constants_of(p)), p);
    check_same(*from_t_form(t_form(p)), p);
  }
}

TEST_CASE("motor parameters: four constants mean equal inductances") {
  ModelConstants without_beta = constants_of(kPaper), without_lm_beta = constants_of(kPaper);
  without_beta.beta = 0.0;
  without_lm_beta.lm_beta = 0.0;
  check_same(*from_constants(without_beta), kPaper);
  check_same(*from_constants(without_lm_beta), kPaper);
}

TEST_CASE("motor parameters: the inverse-Gamma form keeps what the terminals see") {
  const MotorParameters p = *from_inverse_gamma(inverse_gamma_form(kUnequal));
  const ModelConstants a = constants_of(p), b = constants_of(kUnequal);
  CHECK(a.gamma == Approx(b.gamma).epsilon(1e-12));
  CHECK(a.alpha == Approx(b.alpha).epsilon(1e-12));
  CHECK(a.lm_beta == Approx(b.lm_beta).epsilon(1e-12));
  CHECK(a.sigma == Approx(b.sigma).epsilon(1e-12));
}

TEST_CASE("motor parameters: what no motor can have is refused") {
  CHECK(checked({6.6, -1, 0.475, 0.475, 0.454}).error().text == "the motor has rr = -1, allowed: positive numbers");
  CHECK(checked({6.6, 5.5, 0.4, 0.4, 0.4}).error().text == "the motor has lm = 0.4 H, allowed: less than sqrt(ls lr) = 0.4 H");
  CHECK(from_constants({11.6, 0, 100, 0.041, 10.6}).error().text ==
        "gamma = 100 1/s, allowed: above alpha Lm beta = 122.96 1/s, or Rs is not positive");
  CHECK(from_constants({11.6, 0, 283, 0.041, 0}).error().text == "beta or lm_beta is missing");
  CHECK(from_constants({11.6, 30, 283, 0.041, 0}).error().text == "beta sigma = 1.23, allowed: below 1, where Ls = Lr");
}
