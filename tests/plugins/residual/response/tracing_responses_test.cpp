#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>

#include "../declared_base.hpp"
#include "bases/impedance.hpp"
#include "catch.hpp"
#include "linear_effects.hpp"
#include "model/simulate.hpp"
#include "response/response_measurement.hpp"
#include "trace/trace.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

using Complex = std::complex<double>;

const std::vector<double> kDriver = {5.6, 0.3e-3, 7.1, 0.0145, 2.0, 1000.0};

Catalogue catalogue() {
  Catalogue all;
  for (const testing::Linear& e : testing::linear_effects()) all.push_back({e.what, e.effect});
  return all;
}

/// The driver with an effect at its truth, measured with 0.5 % of noise whose variance is stated.
class DriverBench {
 public:
  DriverBench(const std::string& hidden, const std::vector<double>& truth, std::uint64_t seed) : random_(seed) {
    base_ = declared_base<Impedance>();
    truth_.base = base_;
    values_ = Eigen::Map<const Eigen::VectorXd>(kDriver.data(), static_cast<Eigen::Index>(kDriver.size()));
    for (const CatalogueEntry& e : catalogue()) {
      if (e.what.name() != hidden) continue;
      Addition a;
      a.what = e.what;
      a.effect = e.effect;
      if (e.what.acts == Acts::immittance) a.place = e.what.kinds.front() == "coil" ? 0 : 1;
      a.parameters = e.effect->parameters({});
      truth_.additions.push_back(a);
      values_.conservativeResize(values_.size() + static_cast<Eigen::Index>(truth.size()));
      values_.tail(static_cast<Eigen::Index>(truth.size())) =
          Eigen::Map<const Eigen::VectorXd>(truth.data(), static_cast<Eigen::Index>(truth.size()));
    }
  }

  std::shared_ptr<const Measurement> measured(const char* name, double mass) {
    records::ResponseData r;
    r.input_names = {"current"};
    r.output_names = {"voltage"};
    r.response_units = {"ohm"};
    constexpr Eigen::Index kLines = 90;
    r.frequency_hz.resize(kLines);
    r.response.resize(kLines, 1);
    r.variance.resize(kLines, 1);
    for (Eigen::Index k = 0; k < kLines; ++k) {
      r.frequency_hz[k] = 10.0 * std::pow(1000.0, static_cast<double>(k) / (kLines - 1.0));
      const double known[] = {mass};
      const Complex z = joint_response(truth_, values_, known, {0.0, 2.0 * std::numbers::pi * r.frequency_hz[k]})[0];
      const double deviation = 0.005 * std::abs(z);
      r.response(k, 0) = z + deviation / std::sqrt(2.0) * Complex(random_.normal(), random_.normal());
      r.variance(k, 0) = deviation * deviation;
    }
    const auto m = response_measurement(r, name, {mass}, *base_);
    INFO((m ? "" : m.error().text));
    REQUIRE(m);
    return *m;
  }

  Trace traced() {
    TraceData data;
    data.fit = {measured("fit 1", 0.0), measured("fit 2", 0.016)};
    data.select = measured("select", 0.012);
    data.test = measured("test", 0.008);
    auto t = trace(base_, catalogue(), data, {});
    INFO((t ? "" : t.error().text));
    REQUIRE(t);
    return std::move(*t);
  }

 private:
  numerics::Random random_;
  std::shared_ptr<const Impedance> base_;
  JointModel truth_;
  Eigen::VectorXd values_;
};

struct Hidden {
  const char* name;
  std::vector<double> truth;
};

}  // namespace

TEST_CASE("tracing responses: an effect of a driver is named, with its parameters, and the error falls to the floor") {
  const Hidden cases[] = {{"creep", {150.0}},
                          {"eddy_shunt", {0.5e-3, 4.0}},
                          {"semi_inductance", {1.5, 0.6}},
                          {"extra_mode", {600.0, 0.03, 0.5, 0.2}}};
  std::uint64_t seed = 60;
  for (const Hidden& hidden : cases) {
    const Trace t = DriverBench(hidden.name, hidden.truth, ++seed).traced();
    INFO(hidden.name << ", verdict " << word(t.verdict));
    REQUIRE(t.searched.found.size() == 1);
    const Found& found = t.searched.found.front();
    INFO("found " << found.addition.label);
    CHECK(found.addition.name() == hidden.name);
    CHECK(t.after.at_floor());
    CHECK_FALSE(t.after.leak());
    CHECK(t.before.error > t.after.error);
    const Fit& fit = t.searched.best.fit;
    for (std::size_t i = 0; i < hidden.truth.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(kDriver.size() + i);
      INFO(fit.model.parameters()[static_cast<std::size_t>(at)].name);
      CHECK(fit.values()[at] == Approx(hidden.truth[i]).margin(4.0 * fit.std()[at]));
    }
  }
}

TEST_CASE("tracing responses: nothing is found where nothing is missing") {
  int none = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) none += DriverBench("", {}, 900 + seed).traced().verdict == Verdict::none;
  CHECK(none == 6);
}

TEST_CASE("tracing responses: 100 clean drivers give one or two findings at most", "[long]") {
  int none = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) none += DriverBench("", {}, 3000 + seed).traced().verdict == Verdict::none;
  CHECK(none >= 96);  // 1 % of 100: five or more findings have a probability of 0.3 %
}
