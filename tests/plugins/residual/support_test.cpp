#include "trace/support.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "catch.hpp"
#include "fake_measurement.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::test;

namespace {

constexpr double kLevel = 1e-3;

FitParameter length(double high = INFINITY) {
  FitParameter p = positive("length", "m");
  p.high = high;
  return p;
}

/// A base and an effect with an amplitude a and a length, fitted to white or slow noise; the amplitude's column is `shape`.
Fit fit_with(double a, double size, const FitParameter& second, bool slow) {
  Fit f;
  f.model.base = std::make_shared<FakeBase>();
  Addition law = {};
  law.parameters = {real("force", "N", 1.0), second};
  law.place = 0;
  law.situation.place.stored_unit = "m";
  law.situation.place.stored = 0.1;
  f.model.additions = {law};
  f.layout = Coordinates(f.model.parameters(), 1);
  Eigen::VectorXd values(4);
  values << 2.0, 1.0, a, size;
  f.at = f.layout.of(values);
  const Eigen::Index rows = 4000;
  f.jacobian = Eigen::MatrixXd::Zero(rows, 4);
  f.residual.resize(rows);
  numerics::Random random(1);
  double before = 0.0;
  for (Eigen::Index n = 0; n < rows; ++n) {
    const double t = static_cast<double>(n);
    before = slow ? 0.995 * before + 0.1 * random.normal() : random.normal();
    f.residual[n] = before;
    f.jacobian.row(n) << std::sin(0.9 * t), std::cos(0.35 * t), std::sin(0.01 * t), std::sin(0.2 * t);
  }
  f.covariance = pseudo_inverse_normal(f.jacobian);
  f.widening = Eigen::VectorXd::Ones(4);
  f.chi2 = f.residual.squaredNorm();
  return f;
}

}  // namespace

TEST_CASE("support: an amplitude has to stand off 0 by more than the noise makes of it") {
  // Deviation sqrt(2 / 4000) = 0.0224 of the amplitude.
  CHECK(hardly_supported(fit_with(0.2, 0.05, length(), false), 0, {0}, kLevel).empty());
  CHECK(hardly_supported(fit_with(0.03, 0.05, length(), false), 0, {0}, kLevel).find("force = 0.03 can't be told from 0") == 0);
}

TEST_CASE("support: noise that is slow lets an amplitude pass only where it is larger") {
  CHECK_FALSE(hardly_supported(fit_with(0.2, 0.05, length(), true), 0, {0}, kLevel).empty());
  CHECK(hardly_supported(fit_with(2.0, 0.05, length(), true), 0, {0}, kLevel).empty());
}

TEST_CASE("support: a length beyond the movement of the records, or beyond its bound, is not seen in them") {
  CHECK(hardly_supported(fit_with(0.2, 0.3, length(), false), 0, {0}, kLevel) ==
        "length would be 0.3 m, and the records move by no more than 0.1 m to a side");
  CHECK(hardly_supported(fit_with(0.2, 0.09, length(0.05), false), 0, {0}, kLevel) == "length would be above 0.05 m");
}
