#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <numbers>

#include "catch.hpp"
#include "periodic/periodic_measurement.hpp"
#include "periodic/periodic_views.hpp"
#include "periodic_bench.hpp"
#include "sampled/residual_looks.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::small;

namespace {

constexpr double kPi = std::numbers::pi;

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// 4 periods of 64 samples at 64 Hz with lines up to 8, no noise between them that is not `variance`.
PeriodicRecord bare(double variance) {
  PeriodicRecord r;
  r.sample_rate_hz = 64.0;
  r.period = 64;
  r.periods = 4;
  r.input = Eigen::VectorXd::LinSpaced(64, -1.0, 1.0);
  r.input_unit = "N";
  r.output_unit = "m";
  r.output = Eigen::VectorXcd::Zero(33);
  r.variance = Eigen::VectorXd::Constant(33, variance);
  r.frequency_hz = Eigen::VectorXd::LinSpaced(33, 0.0, 8.0);
  r.kind.assign(33, Kind::between);
  for (std::size_t l = 0; l < 33; l += 4) r.kind[l] = l == 0 ? Kind::dc : l % 8 == 4 ? Kind::excited : Kind::even;
  r.kind[3] = r.kind[5] = Kind::skirt;
  return r;
}

}  // namespace

TEST_CASE("views: rows fall into bins of equally many by value, and equal values stay together") {
  Eigen::VectorXd x(96);
  for (Eigen::Index n = 0; n < 96; ++n) x[n] = static_cast<double>((n * 5) % 96);
  const auto bins = bins_by_value(x);
  REQUIRE(bins.size() == 24);
  for (std::size_t b = 0; b < 24; ++b) {
    REQUIRE(bins[b].size() == 4);
    for (const Eigen::Index row : bins[b]) CHECK(static_cast<std::size_t>(x[row]) / 4 == b);
  }
  x.head(50).setConstant(-1.0);
  const auto tied = bins_by_value(x);
  CHECK(tied.front().size() == 50);
  std::size_t rows = 0;
  for (const auto& bin : tied) rows += bin.size();
  CHECK(rows == 96);
  CHECK(bins_by_value(Eigen::VectorXd::Zero(7)).size() == 1);
  CHECK(bins_by_value(Eigen::VectorXd::Zero(3)).size() == 1);
}

TEST_CASE("views: a residual that is the sign of a signal has that mean over it, without error") {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(240, -2.0, 3.0);
  const Eigen::VectorXd sign = x.unaryExpr([](double v) { return v < 0.5 ? -0.25 : 0.25; });
  const MeanMap map = mean_map(sign, x);
  REQUIRE(map.at.size() == 24);
  for (Eigen::Index b = 0; b < 24; ++b) {
    CHECK(map.mean[b] == (b < 12 ? -0.25 : 0.25));
    CHECK(map.std[b] == 0.0);
    CHECK(map.at[b] == Approx(x.segment(10 * b, 10).mean()));
  }
}

TEST_CASE("views: standard errors of conditional means are right for white and for correlated residuals") {
  for (const double colour : {0.0, 0.7}) {
    std::vector<double> deviates;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const Eigen::VectorXd e = noise(6000, 0.3, colour, seed);
      Eigen::VectorXd x(6000);
      for (Eigen::Index n = 0; n < 6000; ++n) x[n] = std::sin(0.013 * static_cast<double>(n));
      const MeanMap map = mean_map(e, x);
      for (Eigen::Index b = 0; b < map.at.size(); ++b) deviates.push_back(map.mean[b] / map.std[b]);
    }
    INFO("colour " << colour);
    CHECK(rms(deviates) > 0.85);
    CHECK(rms(deviates) < 1.25);
  }
}

TEST_CASE("views: a slope stays within its stretch") {
  Eigen::VectorXd x(10);
  x << 0, 2, 4, 6, 8, 100, 97, 94, 91, 88;
  const Eigen::VectorXd slope = slope_of(x, 0.5, {{0, 5}, {5, 5}});
  for (Eigen::Index n = 0; n < 10; ++n) CHECK(slope[n] == (n < 5 ? 4.0 : -6.0));
}

TEST_CASE("views: a residual that grows shows in its blocks") {
  Eigen::VectorXd e(400), t(400);
  for (Eigen::Index n = 0; n < 400; ++n) {
    e[n] = (n % 2 == 0 ? 1.0 : -1.0) * static_cast<double>(n / 10);
    t[n] = 0.1 * static_cast<double>(n);
  }
  const ResidualCourse course = course_by_blocks(e, t);
  REQUIRE(course.rms.size() == 40);
  CHECK(course.axis == "time");
  for (Eigen::Index b = 0; b < 40; ++b) {
    CHECK(course.rms[b] == Approx(static_cast<double>(b)).margin(1e-12));
    CHECK(course.at[b] == Approx(static_cast<double>(b) + 0.45));
  }
  CHECK_FALSE(std::isfinite(course.noise));
}

TEST_CASE("views: the correlation of an alternating residual alternates, and pairs across a break do not count") {
  Eigen::VectorXd e(200);
  for (Eigen::Index n = 0; n < 200; ++n) e[n] = n % 2 == 0 ? 2.0 : -2.0;
  const Autocorrelation whole = autocorrelation(e, 0.01, {{0, 200}}), cut = autocorrelation(e, 0.01, {{0, 100}, {100, 100}});
  REQUIRE(whole.value.size() == 40);
  REQUIRE(cut.value.size() == 25);
  CHECK(whole.value[0] == Approx(-199.0 / 200.0));
  CHECK(whole.value[1] == Approx(198.0 / 200.0));
  CHECK(cut.value[0] == Approx(-198.0 / 200.0));
  CHECK(whole.lag_s[2] == Approx(0.03));
  CHECK(whole.band == Approx(1.96 / std::sqrt(200.0)).epsilon(1e-4));
  CHECK(autocorrelation(Eigen::VectorXd::Zero(200), 0.01, {{0, 200}}).value.size() == 0);
}

TEST_CASE("views: about one lag in twenty of white bins lies outside of the band, of a tone all do") {
  const PeriodicRecord r = bare(1.0);
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Autocorrelation a = views_of(r, noise(65, 1.0, 0.0, seed), {}).autocorrelation;
    REQUIRE(a.value.size() == 16);
    outside += static_cast<int>((a.value.array().abs() > a.band).count());
  }
  CHECK(outside > 15);  // of 960: 48 expected
  CHECK(outside < 75);
  Eigen::VectorXd tone = Eigen::VectorXd::Zero(65);
  tone[7] = 3.0;  // bin 4 of 65 values
  const Autocorrelation a = views_of(r, tone, {}).autocorrelation;
  for (Eigen::Index lag = 1; lag <= 16; ++lag)
    CHECK(a.value[lag - 1] == Approx(std::cos(2.0 * kPi * 4.0 * static_cast<double>(lag) / 65.0)));
  CHECK(a.lag_s[0] == Approx(4.0 / 65.0));
}

TEST_CASE("views: a residual that swings over the record has a period's root mean square each, beside that of the noise") {
  const PeriodicRecord r = bare(0.01);
  Eigen::VectorXcd left = Eigen::VectorXcd::Zero(33);
  left[0] = 0.3;
  left[1] = 0.1;  // 0.3 + 0.2 cos, one turn over the record
  const ResidualCourse course = views_of(r, whitened(r, left), {}).course;
  REQUIRE(course.rms.size() == 4);
  CHECK(course.axis == "period");
  for (Eigen::Index p = 0; p < 4; ++p) {
    double sum = 0.0;
    for (Eigen::Index n = 64 * p; n < 64 * (p + 1); ++n)
      sum += std::pow(0.3 + 0.2 * std::cos(2.0 * kPi * static_cast<double>(n) / 256.0), 2);
    CHECK(course.rms[p] == Approx(std::sqrt(sum / 64.0)));
    CHECK(course.at[p] == static_cast<double>(p + 1));
  }
  CHECK(course.noise == Approx(std::sqrt(0.01 * 65.0)));
}

TEST_CASE("views: the size of a class is the sum of its bins, beside that of the noise") {
  const PeriodicRecord r = bare(0.01);
  Eigen::VectorXcd left = Eigen::VectorXcd::Zero(33);
  left[0] = -0.5;
  left[4] = 0.3;
  left[12] = {0.0, 0.4};
  left[7] = 0.2;
  std::map<std::string, ClassSize> by_name;
  for (const ClassSize& size : class_sizes(r, whitened(r, left))) by_name[size.name] = size;
  CHECK(by_name.size() == 6);  // no odd lines
  CHECK(by_name.at("dc").rms == Approx(0.5));
  CHECK(by_name.at("dc").noise == Approx(0.1));
  CHECK(by_name.at("excited").rms == Approx(std::sqrt(2.0) * 0.5));
  CHECK(by_name.at("excited").noise == Approx(std::sqrt(2.0 * 4.0 * 0.01)));
  CHECK(by_name.at("even").rms == 0.0);
  CHECK(by_name.at("skirts").rms == 0.0);
  CHECK(by_name.at("peak").rms == Approx(std::sqrt(2.0) * 0.2));
  CHECK(by_name.at("peak").noise == Approx(std::sqrt(2.0) * 0.1));
}

TEST_CASE("views: over the record of a plant with an offset in proportion to its input stands a straight line") {
  const auto base = std::make_shared<Mass>();
  base->declared.hold = Hold::zero_order;
  const JointModel model{base, {}};
  const Eigen::VectorXd u = multisine(1.0, 1);
  const Eigen::VectorXd y = simulate(model, mass_values(), {}, drive(model, mass_values(), u)).value().output;
  const double size = 0.01 * std::sqrt(y.squaredNorm() / kPeriod);
  std::vector<double> deviates;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto m =
        periodic_measurement(recording(u, y + 0.05 * size * u, noise(7 * kPeriod, size, 0.5, seed)), "x", {}, *base).value();
    const Eigen::VectorXd left = m->residual(model, mass_values());
    const std::vector<SeenOver> over = m->signals(model, mass_values(), left);
    REQUIRE(over.size() == 7);
    CHECK(over[1].name == "output");
    CHECK(over[2].unit == "m/s");
    CHECK(over[3].name == "flow at bearing");
    // What the model predicts moves as it does.
    const Eigen::VectorXd slope = over[2].values, flow = over[3].values;
    CHECK(slope.dot(flow) > 0.98 * slope.norm() * flow.norm());
    const ResidualViews views = m->views(left, over);
    for (Eigen::Index b = 0; b < 24; ++b) {
      const double expected = 0.05 * size * views.maps[0].at[b];
      deviates.push_back((views.maps[0].mean[b] - expected) / views.maps[0].std[b]);
    }
    CHECK(views.maps[0].mean[23] > 4.0 * views.maps[0].std[23]);
  }
  CHECK(rms(deviates) > 0.85);
  CHECK(rms(deviates) < 1.15);
}
