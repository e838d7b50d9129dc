#include "catch.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::subspace;

namespace {

Lines one_mode(Eigen::Index count) {
  numerics::PoleResidue system;
  system.poles = Eigen::VectorXcd::Constant(1, test::Complex(-0.05, 1.0));
  system.residues.emplace_back(Eigen::MatrixXcd::Constant(1, 1, test::Complex(0.0, -0.5)));
  system.D = Eigen::MatrixXd::Zero(1, 1);
  return test::lines_of(system, test::geometric(0.1, 10.0, count));
}

std::string refusal(const Lines& lines, const Settings& settings = {}) {
  const auto found = identify(lines, {1.0, 0.0}, settings);
  return found ? "" : found.error().text;
}

}  // namespace

TEST_CASE("what is no response is refused by name") {
  Lines lines = one_mode(20);
  lines.response(3, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(lines) == "the response at 0.0329314 Hz is not finite");
  lines = one_mode(20);
  std::swap(lines.omega_rad_s[4], lines.omega_rad_s[5]);
  CHECK(refusal(lines) == "the frequencies do not rise: 0.0419636 Hz after 0.0534732 Hz");
  lines = one_mode(20);
  lines.omega_rad_s[5] = lines.omega_rad_s[4];
  CHECK(refusal(lines) == "the frequencies do not rise: 0.0419636 Hz after 0.0419636 Hz");
  lines = one_mode(20);
  lines.response.setZero();
  CHECK(refusal(lines) == "the response is zero at every line");
  lines = one_mode(20);
  lines.response(7, 0) = 0.0;
  CHECK(relative_weights(lines).error().text == "the response at 0.0868285 Hz is zero: it has no relative error");
}

TEST_CASE("too few lines for the order are refused with what they allow") {
  Settings settings;
  settings.order = 30;
  CHECK(refusal(one_mode(20), settings) == "order 30; allowed with 20 basis functions: 1 to 19");
  settings.order = 2;
  settings.functions = 50;
  CHECK(refusal(one_mode(20), settings) == "");  // as many functions as there are
  CHECK(range_of(one_mode(20), {1.0, 0.0}, 50, Basis::arnoldi).error().text ==
        "50 basis functions; allowed for 20 lines: 2 to 20");
}

TEST_CASE("every second line of a mode is enough to find its order") {
  const auto found = identify(one_mode(30), {1.0, 0.0}, {});
  REQUIRE(found);
  CHECK(found->model.order() == 2);
  CHECK(found->quality.relative < 1e-12);
}
