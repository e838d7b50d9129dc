// Against reference files of an independent prototype: basis-independent numbers alone.

#include "catch.hpp"
#include "plugins/reference_file.hpp"
#include "subspace/stability.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::subspace;
using test::Json;

namespace {

/// re[k][p][m], im[k][p][m] as lines.
Lines lines_in(const Json& file, const std::string& name) {
  const Eigen::VectorXd omega = test::vector_of(file["omega"]);
  std::vector<Eigen::MatrixXcd> all;
  for (std::size_t k = 0; k < static_cast<std::size_t>(omega.size()); ++k) {
    Eigen::MatrixXcd G(2, 2);
    for (std::size_t o = 0; o < 2; ++o)
      for (std::size_t i = 0; i < 2; ++i)
        G(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)) =
            test::Complex(file[name]["re"][k][o][i].get<double>(), file[name]["im"][k][o][i].get<double>());
    all.push_back(G);
  }
  return test::lines_of(omega, all);
}

struct Case {
  const char* name;
  const char* data;
  Basis basis;
  Stability stability;
  double exactness;  ///< of values that rounding or the noise's directions reach
};

}  // namespace

TEST_CASE("singular values, poles and responses are those of the reference, in both bases and both stable forms") {
  const Json file = test::reference_file("rational_fits/subspace_small.json");
  const Case cases[] = {{"exact_mono_none", "G", Basis::powers, Stability::none, 1e-12},
                        {"exact_mono_macie", "G", Basis::powers, Stability::maciejowski, 1e-11},
                        {"exact_arnoldi_none", "G", Basis::arnoldi, Stability::none, 1e-12},
                        {"noisy_mono_none", "Gnoisy", Basis::powers, Stability::none, 1e-11},
                        {"noisy_mono_macie", "Gnoisy", Basis::powers, Stability::maciejowski, 1e-11},
                        {"noisy_arnoldi_none", "Gnoisy", Basis::arnoldi, Stability::none, 1e-11}};
  const Plane plane{file["f"].get<double>(), 0.0};
  for (const Case& one : cases) {
    INFO(one.name);
    const Json& expected = file[one.name];
    const Lines lines = lines_in(file, one.data);
    const auto range = range_of(lines, plane, 8, one.basis);
    REQUIRE(range);
    const Eigen::VectorXd sv = test::vector_of(expected["sv"]);
    CHECK((range->singular_values.head(4) - sv.head(4)).cwiseAbs().maxCoeff() < 1e-12 * sv[0]);
    if (one.data[1] == 'n') CHECK((range->singular_values - sv).cwiseAbs().maxCoeff() < 1e-12 * sv[0]);
    if (one.stability == Stability::maciejowski) continue;
    const auto model = model_of_order(lines, plane, *range, 4, one.stability);
    REQUIRE(model);
    CHECK(test::pole_error(model->circle_poles, test::complex_vector_of(expected["zeig"])) < one.exactness);
    CHECK(test::pole_error(model->poles, test::complex_vector_of(expected["poles"])) < one.exactness);
    Json fitted = file;
    fitted["Ghat"] = expected["Ghat"];
    CHECK(test::relative(model->response, lines_in(fitted, "Ghat").response) < one.exactness);
    CHECK(test::relative(response_of(model->system, lines.omega_rad_s), model->response) < 1e-12);
  }
}

TEST_CASE("Maciejowski's matrix damps what it stabilises, as the reference does") {
  const Json file = test::reference_file("rational_fits/subspace_small.json");
  const Plane plane{file["f"].get<double>(), 0.0};
  const Lines lines = lines_in(file, "G");
  const auto range = range_of(lines, plane, 8, Basis::powers);
  REQUIRE(range);
  // The system is stable: nothing is replaced.
  const auto model = model_of_order(lines, plane, *range, 4, Stability::maciejowski);
  REQUIRE(model);
  CHECK(model->moved == 0);
  CHECK(test::pole_error(maciejowski_matrix(*range, 4, 2).eigenvalues(),
                         test::complex_vector_of(file["exact_mono_macie"]["zeig"])) < 1e-12);
}

TEST_CASE("the stability projection in real Schur form is the reference's, real and stable") {
  const auto found = stable_projection(test::table("stabproj_in.csv"));
  REQUIRE(found);
  CHECK(found->moved > 0);
  CHECK(test::relative(found->A, test::table("stabproj_out.csv")) < 1e-12);
  CHECK(found->A.eigenvalues().cwiseAbs().maxCoeff() < 1.0);
}

TEST_CASE("random matrices are projected into the unit disc, stable ones are left as they are") {
  numerics::Random random(5);
  int moved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::MatrixXd A(6, 6);
    for (double& x : A.reshaped()) x = 0.5 * random.normal();
    const auto found = stable_projection(A);
    REQUIRE(found);
    CHECK(found->A.eigenvalues().cwiseAbs().maxCoeff() < 1.0 + 1e-12);
    moved += found->moved > 0;
    if (found->moved == 0) CHECK(found->A == A);
  }
  CHECK(moved > 50);
  const auto circle = stable_projection(Eigen::Matrix2d{{0.0, 1.0}, {-1.0, 0.0}});
  REQUIRE(circle);
  CHECK(circle->A.eigenvalues().cwiseAbs().maxCoeff() == Approx(1.0 - 1e-10).epsilon(1e-13));
}
