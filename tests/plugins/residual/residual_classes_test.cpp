#include "residual_classes.hpp"

#include <algorithm>
#include <bodeflow/numerics/random.hpp>
#include <map>
#include <vector>

#include "catch.hpp"
#include "motor_standstill.hpp"
#include "simple_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

const MotorStandstill kModel(MotorInput::command, 100e-6);

/// A recording without noise; noise, and what else is wished, is added run by run.
const records::Recording& quiet() {
  static const records::Recording made = [] {
    bench::SimpleBench b;
    b.noise_std = 0.0;
    return bench::record(b, 4.0, 1);
  }();
  return made;
}

Experiment noisy(std::uint64_t seed, double offset = 0.0) {
  numerics::Random random(seed);
  records::Recording r = quiet();
  for (Eigen::Index n = 0; n < r.samples(); ++n) r.output(n, 0) += offset + 0.1 * random.normal();
  return experiment_of(r, "x").value();
}

std::map<std::string, double> p_values(const Experiment& fitted, const Experiment& other, bool of_fitted) {
  const Fit f = fit({&kModel, {}}, {&fitted, 1}, kModel.starts({&fitted, 1}).value()).value();
  std::map<std::string, double> p;
  const Experiment& e = of_fitted ? fitted : other;
  for (const ClassTest& test : test_classes(e, predict(f, e), f.coordinate_covariance, of_fitted)) p[test.name] = test.p;
  return p;
}

}  // namespace

TEST_CASE("residual classes: on noise alone a p below 5 % comes in 5 % of the cases, fitted or not") {
  for (const bool of_fitted : {true, false}) {
    std::map<std::string, int> below;
    const int runs = 60;
    for (int n = 0; n < runs; ++n) {
      for (const auto& [name, p] : p_values(noisy(1000 + 2 * n), noisy(1001 + 2 * n), of_fitted)) below[name] += p < 0.05 ? 1 : 0;
    }
    CHECK(below.size() == 6);
    int all = 0;
    for (const auto& [name, count] : below) {
      INFO(name << (of_fitted ? ", fitted" : ", not fitted"));
      CHECK(count <= 10);  // binomial(60, 0.05) stays below 10 with 99.9 %
      all += count;
    }
    CHECK(all >= 5);  // of 360, 18 expected
    CHECK(all <= 36);
  }
}

TEST_CASE("residual classes: an offset shows at zero frequency alone") {
  const Experiment e = noisy(3, 0.01);
  const auto p = p_values(e, e, true);
  CHECK(p.at("dc") < 1e-8);
  for (const char* other : {"excited", "odd", "even", "skirts", "peak"}) CHECK(p.at(other) > 1e-3);
}

TEST_CASE("residual classes: a tone between the lines shows as a peak") {
  records::Recording r = quiet();
  numerics::Random random(9);
  for (Eigen::Index n = 0; n < r.samples(); ++n) {
    r.output(n, 0) += 0.1 * random.normal() + 0.01 * std::sin(2.0 * 3.14159265358979 * 50.12 * static_cast<double>(n) / 1000.0);
  }
  const Experiment e = experiment_of(r, "x").value();
  CHECK(p_values(e, e, true).at("peak") < 1e-8);
}
