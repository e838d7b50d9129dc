#include "trace/profile.hpp"

#include "catch.hpp"
#include "fake_measurement.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::test;

namespace {

/// The fit of the base with an effect of one positive parameter q that adds size(q) sin(0.5 n), and the profile's widening.
struct Profiled {
  double std = 0.0, value = 0.0;
};
Profiled profiled(const std::function<double(double)>& size, double truth) {
  const auto entry = fake_effect({"bent", {positive("q", "1")}, {{truth}}, [size](const double* p, double n, double) {
                                    return size(p[0]) * std::sin(0.5 * n);
                                  }});
  const double hidden = size(truth);
  const Measurements records{measure({}, [hidden](double n, double) { return hidden * std::sin(0.5 * n); })};
  Addition a;
  a.what = entry.what;
  a.effect = entry.effect;
  a.parameters = entry.effect->parameters({});
  a.label = "bent";
  const JointModel model{std::make_shared<FakeBase>(), {a}};
  const FitProblem problem(model, records);
  Fit f = polish(problem, problem.layout().of(Eigen::Vector3d(2.0, 1.0, truth))).value();
  widen_by_profiles(problem, f);
  return {f.std()[2], f.values()[2]};
}

}  // namespace

TEST_CASE("profile: a parameter in which the effect is linear keeps its deviation") {
  const Profiled p = profiled([](double q) { return q; }, 4.0);
  // Noise of 1 on 300 rows, sum of sin^2 150.
  CHECK(p.std == Approx(1.0 / std::sqrt(150.0)).epsilon(0.05));
}

TEST_CASE("profile: where an effect saturates the interval reaches as far as the data allow") {
  const auto size = [](double q) { return 2.0 * q / (1.0 + q); };
  const Profiled p = profiled(size, 6.0);
  const double slope = 2.0 / ((1.0 + p.value) * (1.0 + p.value)), linear = 1.0 / std::sqrt(150.0) / slope;
  // The upper end: size(end) = size(value) + 1.96 deviations of the size.
  const double top = size(p.value) + 1.96 / std::sqrt(150.0), end = top / (2.0 - top);
  CHECK(1.96 * p.std == Approx(end - p.value).epsilon(0.05));
  CHECK(p.std > 1.2 * linear);
}
