// The block on the reference files, and what it says of data that are not as it assumes.

#include "koopmans_levin/model_block.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numeric>

#include "../block_driver.hpp"
#include "../reference_file.hpp"
#include "../spectrum/record_bytes.hpp"
#include "../spectrum/stream_signals.hpp"
#include "catch.hpp"
#include "examples.hpp"
#include "records/model.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using koopmans_levin::ModelBlock;
using Driver = BlockDriver<ModelBlock>;

namespace {

const std::vector<StreamFacts> kFacts = {stream({"u"}, "V"), stream({"y"}, "A")};

/// A block with texts as parameters, run over two records.
void run(Driver& block, const Eigen::VectorXd& u, const Eigen::VectorXd& y,
         const std::vector<std::pair<std::string, std::string>>& texts, std::size_t chunk = 333) {
  for (const auto& [name, value] : texts) block.set(name, value);
  block.configure();
  block.resolve(kFacts);
  block.activate(1000, Rate(1000, 1));
  feed(block, {{{u.begin(), u.end()}}, {{y.begin(), y.end()}}}, chunk);
  block.finish();
}

void compare(Driver& block, const Json& expected, double tolerance, double noise_tolerance) {
  REQUIRE_FALSE(block.records().empty());
  const RecordView r(*block.records()[0]);
  REQUIRE(r.type() == "model");
  const auto model = records::read_model(r);
  REQUIRE(model);
  const Eigen::VectorXd a = vector_of(expected["alpha"]), b = vector_of(expected["beta"]);
  CHECK(relative_difference(model->denominator.tail(a.size()), a) < tolerance);
  CHECK(relative_difference(model->numerator, b) < tolerance);
  CHECK(relative_difference(model->parameters.head(a.size()), a) < tolerance);
  CHECK(relative_difference(model->parameters.tail(b.size()), b) < tolerance);
  CHECK(r.number("smallest_eigenvalue") == Approx(expected["lambda_u"].get<double>()).epsilon(noise_tolerance));
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& t) { return t.find(part) != std::string::npos; });
}

const Records& noisy_example() {
  static const Records r = [] {
    const Example1 system;
    numerics::Random random(5);
    return noisy(system.clean(random, 3000), random, system.input_noise, system.ratio);
  }();
  return r;
}

}  // namespace

TEST_CASE("koopmans_levin.model: Example 1 of the reference file to 1e-9, in both domains, with and without transient") {
  const Json file = reference_file("errors_in_variables/fdkl_ex1_N250.json");
  const Eigen::VectorXd u = vector_of(file["u"]), y = vector_of(file["y"]);
  for (const auto& [ratio, expected] : file["result_by_rho"].items()) {
    CAPTURE(ratio);
    Driver block;
    run(block, u, y, {{"order", "2"}, {"ratio", ratio}});
    compare(block, expected, 1e-9, 1e-9);
    CHECK(RecordView(*block.records()[0]).number("noise_ratio") == std::stod(ratio));
    CHECK(RecordView(*block.records()[0]).boolean("ratio_determined") == true);
  }
  Driver in_time;
  run(in_time, u, y, {{"order", "2"}, {"ratio", "6"}, {"route", "time_domain"}});
  compare(in_time, file["tdkl_rho6"], 1e-10, 1e-10);
  Driver without;
  without.set("transient", false);
  run(without, u, y, {{"order", "2"}, {"ratio", "6"}});
  compare(without, file["no_transient_rho6"], 1e-9, 1e-9);
  CHECK(any_contains(warnings_of(RecordView(*without.records()[0])), "transient: false is right for whole periods"));
  Driver refined;
  run(refined, u, y, {{"order", "2"}, {"ratio", "6"}, {"refine", "maximum_likelihood"}});
  compare(refined, file["ml_known_rho6"], 2e-4, 1e-8);
}

TEST_CASE("koopmans_levin.model: Example 2 of the reference file, the window of the paper by its rounded end") {
  const Json file = reference_file("errors_in_variables/fdkl_ex2_N2000.json");
  const Eigen::VectorXd u = vector_of(file["u"]), y = vector_of(file["y"]);
  Driver window, identity, full;
  run(window, u, y, {{"order", "4"}, {"ratio", "6"}, {"band", "0:0.625"}});
  compare(window, file["results"]["window_exact_noise_matrix"], 1e-6, 1e-9);
  const RecordView r(*window.records()[0]);
  CHECK((*r.numbers("band"))[0] == 0.0);
  CHECK((*r.numbers("band"))[1] == Approx(1000.0 * 199.0 / 2000.0));
  run(identity, u, y, {{"order", "4"}, {"ratio", "6"}, {"band", "0:0.625"}, {"noise_matrix", "identity"}});
  compare(identity, file["results"]["window_paper_identity"], 1e-6, 1e-6);
  CHECK_FALSE(RecordView(*identity.records()[0]).array("covariance"));
  CHECK(any_contains(warnings_of(RecordView(*identity.records()[0])), "noise_matrix: identity is wrong on a band"));
  run(full, u, y, {{"order", "4"}, {"ratio", "6"}});
  compare(full, file["results"]["all_frequencies"], 1e-9, 1e-9);
}

TEST_CASE("koopmans_levin.model: Example 3 of the reference file, poles in rad/s and Hz by frequency") {
  const Json file = reference_file("errors_in_variables/fdkl_ex3_N4000.json");
  for (const auto& [name, transient] : {std::pair{"fdkl", true}, {"tls_no_transient", false}}) {
    Driver block;
    block.set("order", std::string("4")).set("ratio", std::string("1")).set("transient", transient);
    block.configure();
    auto facts = kFacts;
    for (StreamFacts& f : facts) f.rate = Rate(400, 1);
    block.resolve(facts);
    block.activate(1000, Rate(400, 1));
    const Eigen::VectorXd u = vector_of(file["u_y3"]), y = vector_of(file["y_y1"]);
    feed(block, {{{u.begin(), u.end()}}, {{y.begin(), y.end()}}}, 1000);
    block.finish();
    compare(block, file["results"][name], 1e-9, 1e-9);
    const RecordView r(*block.records()[0]);
    const auto poles = r.array("poles")->as<std::complex<double>>();
    const Eigen::VectorXcd reference = complex_vector_of(file["results"][name]["poles_rad_s"]);
    for (const auto& s : reference) {
      double nearest = 1e300;
      for (const auto& p : poles) nearest = std::min(nearest, std::abs(p - s));
      CHECK(nearest < 1e-5);
    }
    CHECK(poles[0].imag() > 0.0);
    CHECK(poles[0].imag() < poles[2].imag());
    CHECK(r.array("pole_frequency")->as<double>()[2] == Approx(std::abs(poles[2]) / (2.0 * 3.141592653589793)));
  }
}

TEST_CASE("koopmans_levin.model: noise-free data give the system to 1e-10, without the transient they do not") {
  const Example1 system;
  numerics::Random random(6);
  const Records clean = system.clean(random, 300);
  const auto error = [&](bool transient) {
    Driver block;
    block.set("transient", transient);
    run(block, clean.input, clean.output, {{"order", transient ? "auto" : "2"}, {"ratio", "6"}});
    const auto model = records::read_model(RecordView(*block.records()[0]));
    REQUIRE(model);
    REQUIRE(model->order == 2);
    return (model->denominator - Eigen::VectorXd(system.a)).norm() + (model->numerator - Eigen::VectorXd(system.b)).norm();
  };
  CHECK(error(true) < 1e-10);
  CHECK(error(false) > 1e-4);
}

TEST_CASE("koopmans_levin.model: the records are the same bytes for every size of calls, and after reset") {
  const Records& r = noisy_example();
  Driver whole, parts;
  run(whole, r.input, r.output, {{"refine", "maximum_likelihood"}}, 3000);
  run(parts, r.input, r.output, {{"refine", "maximum_likelihood"}}, 7);
  const auto expected = bytes_of(whole.records());
  REQUIRE(expected.size() == 3);
  CHECK(bytes_of(parts.records()) == expected);
  parts.reset();
  feed(parts, {{{r.input.begin(), r.input.end()}}, {{r.output.begin(), r.output.end()}}}, 1000);
  parts.finish();
  const auto all = bytes_of(parts.records());
  CHECK(std::vector(all.begin() + 3, all.end()) == expected);
}

TEST_CASE("koopmans_levin.model: takes the first samples only where a number of them is given") {
  const Records& r = noisy_example();
  Driver first, alone;
  first.set("samples", std::int64_t{700});
  run(first, r.input, r.output, {{"order", "2"}, {"ratio", "6"}});
  run(alone, r.input.head(700), r.output.head(700), {{"order", "2"}, {"ratio", "6"}});
  CHECK(bytes_of(first.records()) == bytes_of(alone.records()));
}

TEST_CASE("koopmans_levin.model: finds order and ratio where neither is given") {
  const Records& r = noisy_example();
  Driver block;
  run(block, r.input, r.output, {});
  const RecordView model(*block.records()[0]), scan(*block.records()[1]);
  CHECK(model.integer("order") == 2);
  CHECK(model.text("ratio_source") == "covariance_matching");
  CHECK(model.boolean("ratio_determined") == true);
  CHECK(std::abs(std::log(*model.number("noise_ratio") / 6.0)) <
        4.0 * *model.number("noise_ratio_std") / *model.number("noise_ratio"));
  CHECK(model.number("output_noise_variance") == Approx(*model.number("noise_ratio") * *model.number("input_noise_variance")));
  CHECK(scan.type() == "order_scan");
  CHECK(scan.integer("chosen") == 2);
  CHECK(scan.array("noise_variance")->as<double>()[0] > 1.5 * scan.array("noise_variance")->as<double>()[1]);
  CHECK(RecordView(*block.records()[2]).type() == "whiteness");
  CHECK(*RecordView(*block.records()[2]).number("probability") > 0.001);
}

TEST_CASE("koopmans_levin.model: a ratio that the data do not tell gives no model, or the one asked for with a warning") {
  const Example1 system;
  numerics::Random random(72);
  const Records r = noisy(system.clean(random, 40), random, system.input_noise, system.ratio);
  Driver strict;
  const std::string text = failure_of([&] { run(strict, r.input, r.output, {{"order", "2"}}); });
  CHECK(text.rfind("the noise ratio is not determined: ", 0) == 0);
  CHECK(text.find("; give ratio, output_noise or noise_band, record longer, or set fallback_ratio") != std::string::npos);
  CHECK(strict.records().empty());

  Driver lenient;
  lenient.set("fallback_ratio", 6.0);
  run(lenient, r.input, r.output, {{"order", "2"}});
  const RecordView model(*lenient.records()[0]);
  CHECK(model.boolean("ratio_determined") == false);
  CHECK(model.text("ratio_source") == "fallback");
  CHECK(model.number("noise_ratio") == 6.0);
  CHECK(warnings_of(model).front().rfind("the noise ratio is not determined: ", 0) == 0);
}

TEST_CASE("koopmans_levin.model: a band without signal gives the ratio of a narrow band") {
  const Example2 system;
  numerics::Random random(8);
  const Records r = noisy(system.clean(random, 8000), random, system.input_noise, system.ratio);
  Driver block;
  run(block, r.input, r.output, {{"order", "4"}, {"band", "0:0.625"}, {"noise_band", "2:3.14"}});
  const RecordView model(*block.records()[0]);
  CHECK(model.text("ratio_source") == "noise_band");
  CHECK(model.number("output_noise_variance") == Approx(0.6).epsilon(0.1));
  CHECK(*model.number("noise_ratio") / 6.0 == Approx(1.0).margin(4.0 * *model.number("noise_ratio_std") / 6.0));
}

TEST_CASE("koopmans_levin.model: warns of a ratio that matters, of coloured noise with its band, of offsets and few lines") {
  const Example1 system;
  const auto warnings = [](const Eigen::VectorXd& u, const Eigen::VectorXd& y, const std::string& order) {
    Driver block;
    run(block, u, y, {{"order", order}, {"ratio", "6"}});
    const auto all = warnings_of(RecordView(*block.records()[0]));
    CHECK(block.log().size() == all.size());
    return std::accumulate(all.begin(), all.end(), std::string());
  };
  using Catch::Contains;
  const Records& r = noisy_example();
  CHECK_THAT(warnings(r.input, r.output, "2"),
             Contains("a factor 2 in the noise ratio moves 4 parameters by more than one standard deviation"));
  CHECK_THAT(warnings(r.input, r.output, "2"), !Contains("not white"));
  CHECK_THAT(warnings(r.input, r.output, "2"), !Contains("offset"));
  CHECK_THAT(warnings(r.input, r.output, "1"), Contains("the equation errors are not white"));

  numerics::Random random(9);
  const Records clean = system.clean(random, 3000);
  const Eigen::VectorXd coloured = filtered(Eigen::VectorXd::Ones(1), Eigen::Vector2d(1.0, -0.8), white(random, 3000, 0.3));
  const std::string of_coloured = warnings(clean.input + white(random, 3000, 0.1), clean.output + coloured, "2");
  CHECK_THAT(of_coloured, Contains("not white (probability below 1e-12): from 0.0833 to 24.9 Hz they have 7.65 times the power"));
  CHECK_THAT(of_coloured, !Contains("offset"));
  CHECK_THAT(warnings(r.input, r.output.array() + 3.0, "2"),
             Contains("an offset of a sensor; leave line 0 out with a band from 0.333 Hz on"));
  CHECK_THAT(warnings(r.input.head(16), r.output.head(16), "2"), Contains("few lines: 16 equations for 7 parameters"));
}

TEST_CASE("koopmans_levin.model: warns of unstable poles and of an order that was not found") {
  const Records& r = noisy_example();
  Driver block;
  block.set("highest_order", std::int64_t{2});
  run(block, r.input, r.output, {{"ratio", "6"}});
  const RecordView model(*block.records()[0]);
  CHECK(model.integer("order") == 2);
  CHECK(any_contains(warnings_of(model), "no order was found: the noise still falls at order 2, the highest tried"));
  // 1.25 y[t] = 0.8 .. : the same record with input and output exchanged has the zeros of B as poles, of which one made unstable.
  numerics::Random random(10);
  const Records clean =
      simulated(Eigen::Vector2d(1.0, -1.25), Eigen::Vector2d(1.0, -0.5), 2000, 10, [&] { return random.normal(); });
  Driver inverse;
  run(inverse, clean.output + white(random, 2000, 0.001), clean.input + white(random, 2000, 0.001),
      {{"order", "1"}, {"ratio", "1"}});
  CHECK(any_contains(warnings_of(RecordView(*inverse.records()[0])), "1 pole outside the unit circle (35.6 Hz)"));
}

TEST_CASE("koopmans_levin.model: refuses by name what it cannot use") {
  const auto refusal = [](const std::vector<std::pair<std::string, std::string>>& texts) {
    return failure_of([&] {
      Driver block;
      run(block, noisy_example().input, noisy_example().output, texts);
    });
  };
  CHECK(refusal({{"order", "two"}}) == "order: 'two' is not a number; allowed: a number, or auto");
  CHECK(refusal({{"order", "2.5"}}) == "order: '2.5'; allowed: 1 to 64, or auto");
  CHECK(refusal({{"ratio", "0"}}) == "ratio: '0'; allowed: 1e-12 to 1e12, or auto");
  CHECK(refusal({{"ratio", "6"}, {"noise_band", "2:3"}}) ==
        "ratio is given, so output_noise and noise_band have no use: leave them out, or set ratio: auto");
  CHECK(refusal({{"order", "2"}, {"ratio", "6"}, {"route", "time_domain"}, {"band", "0:1"}}) ==
        "route: time_domain is the full range: leave out band");
  CHECK(refusal({{"band", "600 Hz:700 Hz"}}) == "band '600 Hz:700 Hz': the upper end is above half the sample rate (500 Hz)");
  CHECK(refusal({{"order", "4"}, {"ratio", "6"}, {"band", "0 Hz:1 Hz"}}) ==
        "order 4 needs at least 14 real equations (2 a line, 1 at zero frequency); the band has 7");

  Driver block;
  block.set("max_samples", std::int64_t{100});
  CHECK(failure_of([&] { run(block, noisy_example().input, noisy_example().output, {}); }) ==
        "the records have more than max_samples, 100 samples");
  Driver more;
  more.set("samples", std::int64_t{4000});
  CHECK(failure_of([&] { run(more, noisy_example().input, noisy_example().output, {}); }) ==
        "only 3000 samples arrived; samples asks for 4000");
  Driver empty;
  empty.configure();
  empty.resolve(kFacts);
  empty.activate(1000, Rate(1000, 1));
  CHECK(failure_of([&] { empty.finish(); }) == "no samples arrived");
  Eigen::VectorXd broken = noisy_example().input;
  broken[700] = std::numeric_limits<double>::quiet_NaN();
  Driver nan;
  CHECK(failure_of([&] { run(nan, broken, noisy_example().output, {}); }) == "input 'u': sample 700 is not a number");
  Driver wide;
  wide.configure();
  CHECK(failure_of([&] {
          wide.resolve({stream({"a", "b"}, "V"), stream({"y"}, "A")});
        }) == "the input has 2 channels; allowed: one");
}
