#include "validation/monte_carlo.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>

#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "validation/monte_carlo_block.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;
using Complex = std::complex<double>;

namespace {

using Values = std::vector<double>;

void put(RecordBuilder& r, const char* name, const char* unit, std::vector<std::uint64_t> shape, const Values& values) {
  const auto data = r.array<double>(name, unit, shape);
  std::copy(values.begin(), values.end(), data.begin());
}

/// Three runs of a discrete-time model b / (z + a) with its covariance, as a swept phase leaves them.
RecordBuilder three_runs() {
  RecordBuilder r("sweep");
  r.set("of", "model");
  r.set("runs", std::int64_t{3});
  r.set("parameter_names", {std::string("a"), std::string("b")});
  r.set("parameter_units", {std::string("1"), std::string("V")});
  put(r, "axis.seed", "", {3}, {4, 5, 6});
  put(r, "parameters", "", {3, 2}, {-0.5, 1, -0.6, 2, -0.4, 6});
  put(r, "covariance", "", {3, 2, 2}, {1, 0, 0, 4, 1, 0, 0, 4, 1, 0, 0, 16});
  put(r, "numerator", "", {3, 1}, {1, 2, 6});
  put(r, "denominator", "", {3, 2}, {1, -0.5, 1, -0.6, 1, -0.4});
  put(r, "sample_time", "", {3}, {0.01, 0.01, 0.01});
  put(r, "input_noise_variance", "", {3}, {0.1, 0.2, 0.3});
  const auto poles = r.array<Complex>("poles", "rad/s", {3, 2});
  for (std::size_t i = 0; i < 6; ++i) poles[i] = {-static_cast<double>(i), i % 2 == 0 ? 7.0 : -7.0};
  return r;
}

std::vector<double> list(const RecordView& record, const char* name) {
  const auto array = record.array(name);
  REQUIRE(array);
  const auto data = array->as<double>();
  return {data.begin(), data.end()};
}

std::vector<std::string> texts(const RecordView& record, const char* name) {
  const auto found = record.texts(name);
  REQUIRE(found);
  return {found->begin(), found->end()};
}

void study(BlockDriver<MonteCarlo>& block, const RecordBuilder& sweep) {
  block.configure();
  block.resolve({});
  block.activate(1, {1, 1});
  block.receive(sweep, 0.0);
  block.finish();
}

}  // namespace

TEST_CASE("monte_carlo: mean, spread, bias and coverage of hand-made runs") {
  BlockDriver<MonteCarlo> block;
  block.set("truth", Values{-0.5, 2.5}).set("published_mean", Values{-0.51, 2.4}).set("published_std", Values{0.1, 2.0});
  study(block, three_runs());
  REQUIRE(block.records().size() == 2);
  const RecordView record(*block.records()[0]);
  CHECK(record.type() == "monte_carlo");
  CHECK(record.integer("runs") == 3);
  CHECK(record.integer("seed") == 4);
  CHECK(record.integer("last_seed") == 6);
  CHECK(texts(record, "quantity_names") == std::vector<std::string>{"a", "b"});
  CHECK(texts(record, "quantity_units") == std::vector<std::string>{"1", "V"});
  CHECK(list(record, "mean")[1] == Approx(3.0).epsilon(1e-15));
  CHECK(list(record, "std")[0] == Approx(0.1).epsilon(1e-14));
  CHECK(list(record, "std")[1] == Approx(std::sqrt(7.0)).epsilon(1e-14));
  CHECK(list(record, "bias")[1] == Approx(0.5).epsilon(1e-14));
  CHECK(list(record, "published_std") == Values{0.1, 2.0});
  CHECK(list(record, "predicted_std")[1] == Approx(std::sqrt(8.0)));  // the variances are 4, 4 and 16
  CHECK(list(record, "coverage") == Values{1.0, 1.0});                // the widest distance: 3.5, within 1.96 * 4
}

TEST_CASE("monte_carlo: several arrays, complex entries, a scale and names of one's own") {
  BlockDriver<MonteCarlo> block;
  block.set("quantities", std::vector<std::string>{"b", "input_noise_variance", "poles[1]"})
      .set("scale", Values{1, 10, -1, 1})
      .set("names", std::vector<std::string>{"gain", "noise", "re p", "im p"})
      .set("units", std::vector<std::string>{"mV", "V^2", "1/s", "1/s"});
  study(block, three_runs());
  const RecordView record(*block.records()[0]);
  CHECK(texts(record, "quantity_names") == std::vector<std::string>{"gain", "noise", "re p", "im p"});
  CHECK(list(record, "mean")[0] == Approx(3.0));
  CHECK(list(record, "mean")[1] == Approx(2.0));
  CHECK(list(record, "mean")[2] == Approx(3.0));  // -(−1 − 3 − 5) / 3
  CHECK(list(record, "mean")[3] == Approx(-7.0));
  CHECK(list(record, "std")[3] == Approx(0.0).margin(1e-15));
  CHECK(std::isnan(list(record, "predicted_std")[1]));
  CHECK_FALSE(record.array("coverage"));  // no truth
}

TEST_CASE("monte_carlo: the mean of the models' responses and its scatter") {
  BlockDriver<MonteCarlo> block;
  block.set("frequency.count", std::int64_t{5}).set("frequency.first", 10.0);
  study(block, three_runs());
  const auto d = records::read_response(RecordView(*block.records()[1]));
  REQUIRE(d);
  REQUIRE(d->frequency_hz.size() == 5);
  CHECK(d->frequency_hz[0] == 10.0);
  CHECK(d->frequency_hz[4] == 50.0);
  const Complex z(-1.0, 0.0);  // at half the sample rate
  const Complex g[] = {1.0 / (z - 0.5), 2.0 / (z - 0.6), 6.0 / (z - 0.4)};
  const Complex mean = (g[0] + g[1] + g[2]) / 3.0;
  CHECK(std::abs(d->response(4, 0) - mean) < 1e-13);
  CHECK(d->variance(4, 0) == Approx((std::norm(g[0] - mean) + std::norm(g[1] - mean) + std::norm(g[2] - mean)) / 2.0));
  CHECK(d->degrees_of_freedom == 2.0);
}

TEST_CASE("monte_carlo: runs that are responses are averaged line by line") {
  RecordBuilder r("sweep");
  r.set("of", "frequency_response");
  r.set("runs", std::int64_t{2});
  put(r, "frequency", "Hz", {2, 2}, {1, 3, 1, 3});
  const auto g = r.array<Complex>("response", "V/A", {2, 2, 1, 1});
  g[0] = {1, 1}, g[1] = {2, 0}, g[2] = {3, 1}, g[3] = {2, 4};
  BlockDriver<MonteCarlo> block;
  block.set("quantities", std::vector<std::string>{"response[1,0,0]"});
  study(block, r);
  CHECK(texts(RecordView(*block.records()[0]), "quantity_names")[1] == "im(response[1,0,0])");
  const auto d = records::read_response(RecordView(*block.records()[1]));
  REQUIRE(d);
  CHECK(d->response(0, 0) == Complex(2, 1));
  CHECK(d->variance(0, 0) == 2.0);
  CHECK(d->variance(1, 0) == 8.0);
  CHECK(d->response_units[0] == "V/A");
}

TEST_CASE("monte_carlo: the coverage of right deviations is 95 percent, and of halved ones 67") {
  numerics::Random random(7);
  Eigen::VectorXd values(4000);
  for (double& v : values) v = 3.0 + 0.2 * random.normal();
  CHECK(spread(values).std == Approx(0.2).epsilon(0.04));
  CHECK(coverage(values, Eigen::VectorXd::Constant(4000, 0.2), 3.0) == Approx(0.95).margin(0.011));
  CHECK(coverage(values, Eigen::VectorXd::Constant(4000, 0.1), 3.0) == Approx(0.673).margin(0.023));
}

TEST_CASE("monte_carlo: what does not fit is refused by name") {
  const auto refusal = [](auto prepare, const RecordBuilder& sweep) {
    BlockDriver<MonteCarlo> block;
    return failure_of([&] {
      prepare(block);
      study(block, sweep);
    });
  };
  const auto nothing = [](auto&) {};
  const auto with = [](const char* name, auto value) { return [=](auto& block) { block.set(name, value); }; };
  using Names = std::vector<std::string>;

  CHECK(refusal(nothing, RecordBuilder("model")) ==
        "a record of type 'model'; needed: sweep, as a phase with `sweep:` leaves it");
  CHECK(refusal(with("quantities", Names{"gamma"}), three_runs()) ==
        "the sweep has no 'gamma'; it has: a, b, axis.seed, parameters, covariance, numerator, denominator, sample_time, "
        "input_noise_variance, poles");
  CHECK(refusal(with("quantities", Names{"poles[2]"}), three_runs()) == "array 'poles' has no entry [2]; the last is [1]");
  CHECK(refusal(with("truth", Values{1, 2, 3}), three_runs()) == "truth has 3 values for 2 numbers: a, b");
  CHECK(refusal(with("scale", Values{1, 2, 3}), three_runs()) == "scale has 3 values for 2 numbers: a, b");
  CHECK(refusal(with("published_std", Values{1, -2}), three_runs()) == "published_std: -2 is no standard deviation");
  CHECK(refusal(with("frequency.last", 60.0), three_runs()) ==
        "frequency.last: 60 Hz is above half the sample rate of the models, 50 Hz");
  CHECK(refusal(with("quantities", Names{}), three_runs()) == "quantities is empty; needed: at least one");

  RecordBuilder one("sweep");
  one.set("runs", std::int64_t{1});
  CHECK(refusal(nothing, one) == "the sweep has 1 run; a spread needs at least 2");
  RecordBuilder apart("sweep");
  apart.set("runs", std::int64_t{2});
  apart.set("not_merged", {std::string("parameters")});
  CHECK(refusal(nothing, apart) == "the sweep has no 'parameters' (its shape differs from run to run); it has: nothing");
  RecordBuilder infinite("sweep");
  infinite.set("runs", std::int64_t{2});
  put(infinite, "parameters", "", {2, 1}, {1.0, INFINITY});
  CHECK(refusal(nothing, infinite) == "'parameters[0]' is not finite in run 1");

  BlockDriver<MonteCarlo> empty;
  empty.configure();
  CHECK(failure_of([&] { empty.finish(); }) == "no sweep arrived; connect the record of a phase with `sweep:`");
  BlockDriver<MonteCarlo> twice;
  twice.configure();
  twice.receive(three_runs(), 0.0);
  CHECK(failure_of([&] { twice.receive(three_runs(), 0.0); }) == "a second sweep arrived; one study takes one");
}

TEST_CASE("monte_carlo: refuses runs that differ in more than their seed, and a seed that occurs twice") {
  const auto refusal = [](auto change) {
    RecordBuilder r("sweep");
    r.set("of", "model");
    r.set("runs", std::int64_t{3});
    put(r, "gain", "", {3}, {1, 2, 3});
    change(r);
    BlockDriver<MonteCarlo> block;
    block.set("quantities", std::vector<std::string>{"gain"});
    return failure_of([&] { study(block, r); });
  };
  CHECK(
      refusal([](RecordBuilder& r) {
        put(r, "axis.seed", "", {3}, {1, 2, 3});
        put(r, "axis.bench.noise", "", {3}, {1, 2, 3});
      }) ==
      "the runs differ in 'bench.noise'; a study takes runs that differ in their seed alone: sweep the seed, one study for each "
      "'bench.noise'");
  CHECK(refusal([](RecordBuilder& r) {
          r.set("axis.mode", std::vector<std::string>{"a", "b", "c"});
        }).rfind("the runs differ in 'mode';", 0) == 0);
  CHECK(refusal([](RecordBuilder& r) {
          put(r, "axis.seed", "", {3}, {7, 1, 7});
        }) == "seed 7 occurs twice: these runs are one and the same, and the spread too small");
}
