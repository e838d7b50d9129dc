// Against the iterates, poles and residues of an independent prototype (tests/data/rational_fits).

#include "../reference_file.hpp"
#include "catch.hpp"
#include "sanathanan_koerner/fit.hpp"
#include "sanathanan_koerner/monomial.hpp"
#include "sanathanan_koerner/vector_fitting.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;
using test::Json;

namespace {

Eigen::MatrixXcd matrix_of(const Json& parts) {
  const auto re = parts["re"].get<std::vector<std::vector<double>>>(), im = parts["im"].get<std::vector<std::vector<double>>>();
  Eigen::MatrixXcd m(static_cast<Eigen::Index>(re.size()), static_cast<Eigen::Index>(re[0].size()));
  for (Eigen::Index k = 0; k < m.rows(); ++k)
    for (Eigen::Index i = 0; i < m.cols(); ++i)
      m(k, i) = {re[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)],
                 im[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)]};
  return m;
}

struct Case {
  Json file = test::reference_file("rational_fits/sk_vf_small.json");
  Eigen::MatrixXcd truth = matrix_of(file["G"]);
  Plane plane{file["alpha"].get<double>(), 0.0};

  Data data(bool noisy) const { return test::data_of(test::vector_of(file["omega"]), noisy ? matrix_of(file["Gnoisy"]) : truth); }
};

/// Iterations as many as wanted, whatever the error does.
StopRule exactly(int iterations) { return {iterations, 0.0, 1000}; }

}  // namespace

TEST_CASE("monomial: denominators and errors are those of the prototype iterate by iterate") {
  const Case c;
  for (const auto& [name, noisy, exponent] : {std::tuple("SK_exact_d", false, 1.0), std::tuple("SK_exact_sqrt", false, 0.5),
                                              std::tuple("SK_noisy_d", true, 1.0), std::tuple("SK_noisy_sqrt", true, 0.5)}) {
    const Json& expected = c.file[name];
    const auto found = monomial_iterates(c.data(noisy), c.plane, {6, exponent, true, exactly(4)});
    REQUIRE(found);
    // Data without noise are exact after one iterate; the iteration may end before the fourth.
    REQUIRE(found->size() == (noisy ? 4u : found->size()));
    for (std::size_t i = 0; i < found->size(); ++i) {
      INFO(name << ", iterate " << i + 1);
      CHECK(test::relative_difference((*found)[i].denominator, test::vector_of(expected[i]["den_zinv"])) < 1e-12);
      const auto rows = expected[i]["num_zinv_refit"].get<std::vector<std::vector<double>>>();
      for (std::size_t m = 0; m < rows.size(); ++m)
        for (std::size_t channel = 0; channel < 3; ++channel)
          CHECK((*found)[i].numerators(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(channel)) ==
                Approx(rows[m][channel]).margin(1e-11));
      CHECK((*found)[i].error == Approx(expected[i]["relerr_data"].get<double>()).epsilon(1e-8).margin(1e-13));
    }
  }
}

TEST_CASE("fit: orthonormal and relaxed, it has the poles and the error of the prototype") {
  const Case c;
  for (const bool noisy : {false, true}) {
    const Json& expected = c.file[noisy ? "SKarnoldi_noisy" : "SKarnoldi_exact"];
    const auto found = fit(c.data(noisy), c.plane, {6, 1.0, true, exactly(15)});
    REQUIRE(found);
    CHECK(test::worst_match(found->poles, test::complex_vector_of(expected["poles"])) < (noisy ? 2e-7 : 1e-12));
    CHECK(found->error() == Approx(expected["relerr_data"].get<double>()).epsilon(1e-6).margin(1e-13));
    CHECK(test::relative_error(found->response, c.truth) ==
          Approx(expected["relerr_true"].get<double>()).epsilon(1e-4).margin(1e-13));
  }
}

TEST_CASE("vector fitting: errors by iteration and poles and residues are those of the prototype") {
  const Case c;
  for (const bool noisy : {false, true}) {
    const Json& expected = c.file[noisy ? "RVF_noisy" : "RVF_exact"];
    const auto history = expected["hist"].get<std::vector<double>>();
    const Data data = c.data(noisy);
    const VectorFittingSettings settings{6, Spacing::linear, true, exactly(static_cast<int>(history.size()))};
    const auto found =
        vector_fit(data, settings, initial_poles({data.omega_rad_s[0], data.omega_rad_s[data.lines() - 1]}, 6, Spacing::linear));
    REQUIRE(found);
    for (std::size_t i = 0; noisy && i < 4; ++i) CHECK(found->course.errors[i] == Approx(history[i]).epsilon(1e-5));
    CHECK(found->error() == Approx(history.back()).epsilon(1e-9).margin(1e-13));
    CHECK(test::worst_match(all_poles(found->model.poles), test::complex_vector_of(expected["poles"])) < (noisy ? 1e-8 : 1e-12));
    // Their rows: real and imaginary part of each pair's residue, then D; pairs in the order of their poles.
    const auto rows = expected["residue_rows_re_im_then_D"].get<std::vector<std::vector<double>>>();
    const Eigen::VectorXcd theirs = test::complex_vector_of(expected["poles"]);
    for (std::size_t n = 0; n < 3; ++n) {
      Eigen::Index mine = 0;
      const auto& pairs = found->model.poles.pairs;
      for (std::size_t m = 1; m < 3; ++m)
        if (std::abs(pairs[m] - theirs[static_cast<Eigen::Index>(n)]) <
            std::abs(pairs[static_cast<std::size_t>(mine)] - theirs[static_cast<Eigen::Index>(n)]))
          mine = static_cast<Eigen::Index>(m);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const auto column = static_cast<Eigen::Index>(channel);
        CHECK(found->model.coefficients(2 * mine, column) == Approx(rows[2 * n][channel]).margin(1e-9).epsilon(1e-6));
        CHECK(found->model.coefficients(2 * mine + 1, column) == Approx(rows[2 * n + 1][channel]).margin(1e-9).epsilon(1e-6));
      }
    }
  }
}
