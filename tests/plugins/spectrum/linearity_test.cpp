// Up to which amplitude a plant is linear.

#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "record_bytes.hpp"
#include "spectrum/linearity_block.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;

namespace {

constexpr Eigen::Index kLines = 24;
constexpr double kDegrees = 7.0;

/// The response of a first-order plant, its gain changed by `change`, measured with noise of `deviation` whose variance is an
/// estimate of 7 complex degrees of freedom, as 8 periods give it.
ResponseData measured(numerics::Random& random, double deviation, double change = 0.0) {
  ResponseData d;
  d.form = "errors_in_variables";
  d.input_names = {"voltage"};
  d.output_names = {"current"};
  d.response_units = {"A/V"};
  d.degrees_of_freedom = kDegrees;
  d.frequency_hz = Eigen::VectorXd::LinSpaced(kLines, 1.0, 47.0);
  d.response.resize(kLines, 1);
  d.variance.resize(kLines, 1);
  const double half = deviation * std::sqrt(0.5);
  for (Eigen::Index k = 0; k < kLines; ++k) {
    const Complex g = (1.0 + change) / Complex(1.0, 0.1 * d.frequency_hz[k]);
    d.response(k, 0) = g + half * Complex(random.normal(), random.normal());
    double sum = 0.0;
    for (int i = 0; i < 14; ++i) sum += std::pow(random.normal(), 2);
    d.variance(k, 0) = deviation * deviation * sum / 14.0;
  }
  return d;
}

LevelComparison compared(numerics::Random& random, double change) {
  const auto l = linearity({measured(random, 0.05), measured(random, 0.02, change)}, {1.0, 4.0}, 0.01);
  REQUIRE(l);
  return l->comparisons.front();
}

std::string refusal(std::vector<ResponseData> all, std::vector<double> amplitudes, double significance = 0.01) {
  const auto l = linearity(all, amplitudes, significance);
  return l ? "accepted" : l.error().text;
}

/// The record of a response with mean spectra: an input of `amplitude` peak at every line.
RecordBuilder with_spectra(const ResponseData& d, double amplitude) {
  RecordBuilder r = write_response(d);
  const auto lines = static_cast<std::uint64_t>(kLines);
  const auto fill = [&](auto data, auto value) { std::fill(data.begin(), data.end(), value); };
  fill(r.array<Complex>("input_mean", "V", {lines, 1}), Complex(0.0, 0.5 * amplitude));
  fill(r.array<Complex>("output_mean", "A", {lines, 1}), Complex(1.0, 0.0));
  fill(r.array<double>("input_variance", "V^2", {lines, 1}), 0.0);
  fill(r.array<double>("output_variance", "A^2", {lines, 1}), 1e-6);
  fill(r.array<Complex>("cross_covariance", "", {lines, 1, 1}), Complex(0.0));
  return r;
}

void start(BlockDriver<LinearityBlock>& block) {
  block.configure();
  block.resolve({});
  block.activate(1, Rate(1, 1));
}

}  // namespace

TEST_CASE("linearity: where only noise differs probabilities are uniform, and groups of lines find smooth changes") {
  numerics::Random random(4);
  constexpr int kSets = 1000;
  Eigen::Array4d lines = Eigen::Array4d::Zero(), smooth = lines, both = lines;
  const Eigen::Array4d limits(0.01, 0.1, 0.5, 0.9);
  for (int set = 0; set < kSets; ++set) {
    const LevelComparison c = compared(random, 0.0);
    lines += (c.lines_p_value < limits).cast<double>() / kSets;
    smooth += (c.smooth_p_value < limits).cast<double>() / kSets;
    both += (c.p_value < limits).cast<double>() / kSets;
  }
  CAPTURE(lines.transpose(), smooth.transpose(), both.transpose());
  // Satterthwaite's degrees of freedom are an approximation; .02 is what it may cost.
  const Eigen::Array4d slack = 4.0 * (limits * (1.0 - limits) / kSets).sqrt() + 0.02;
  CHECK(((lines - limits).abs() < slack).all());
  CHECK(((smooth - limits).abs() < slack).all());
  CHECK((both < limits + slack).all());
  // A change of the gain by 10 % at a noise of 5 to 25 % a line shows better in groups of lines.
  int by_lines = 0, by_groups = 0;
  for (int set = 0; set < 100; ++set) {
    const LevelComparison c = compared(random, 0.1);
    by_lines += c.lines_p_value < 0.01 ? 1 : 0;
    by_groups += c.smooth_p_value < 0.01 ? 1 : 0;
  }
  CAPTURE(by_lines, by_groups);
  CHECK(by_groups > by_lines);
  int found = 0;
  for (int set = 0; set < 100; ++set) found += compared(random, 0.3).p_value < 0.01 ? 1 : 0;
  CHECK(found == 100);
}

TEST_CASE("linearity: of four levels in any order the last one before the first difference is recommended") {
  numerics::Random random(9);
  const std::vector<ResponseData> all = {measured(random, 0.01, 0.2), measured(random, 0.02), measured(random, 0.005, 0.5),
                                         measured(random, 0.04)};
  const auto l = linearity(all, {4.0, 2.0, 8.0, 1.0}, 0.01);
  REQUIRE(l);
  CHECK(l->amplitudes == std::vector<double>{1.0, 2.0, 4.0, 8.0});
  CHECK(l->order == std::vector<std::size_t>{3, 1, 0, 2});
  CHECK_FALSE(l->linear());
  CHECK(l->linear_levels == 2);
  CHECK(l->largest_linear() == 2.0);
  CHECK(l->comparisons.size() == 3);
  CHECK(l->comparisons[0].p_value > 0.01);
  CHECK(l->comparisons[1].p_value < 1e-6);
  CHECK(l->p_value == l->comparisons[1].p_value);
  CHECK(l->comparisons[1].relative_difference == Approx(0.2).epsilon(0.1));
  CHECK(l->comparisons[2].relative_difference == Approx(0.5).epsilon(0.1));
}

TEST_CASE("linearity: exact responses agree where they are equal and differ where they are not") {
  numerics::Random random(1);
  ResponseData a = measured(random, 0.0), b = a;
  CHECK(linearity({a, b}, {1.0, 2.0}, 0.01)->linear());
  b.response(3, 0) += 1e-9;
  const auto l = linearity({a, b}, {1.0, 2.0}, 0.01);
  CHECK_FALSE(l->linear());
  CHECK(l->largest_linear() == 1.0);
  CHECK(l->comparisons[0].line_p_value[3] == 0.0);
  CHECK(l->comparisons[0].line_p_value[4] == 1.0);
}

TEST_CASE("linearity: what can't be compared is refused by name") {
  numerics::Random random(2);
  const ResponseData d = measured(random, 0.01);
  CHECK(refusal({d}, {1.0}) == "1 response; needed: at least 2, at different amplitudes");
  CHECK(refusal({d, d}, {1.0}) == "1 amplitude for 2 responses");
  CHECK(refusal({d, d}, {1.0, 1.0}) == "two responses have the amplitude 1; needed: all different");
  CHECK(refusal({d, d}, {1.0, 0.0}) == "response 2 has the amplitude 0; needed: above 0");
  CHECK(refusal({d, d}, {1.0, 2.0}, 1.0) == "a significance of 1; allowed: between 0 and 1");
  ResponseData other = d;
  other.frequency_hz[2] += 0.1;
  CHECK(refusal({d, other}, {1.0, 2.0}) ==
        "response 2 has a line at 5.1 Hz where the first one has 5 Hz; needed: the same lines");
  other = d;
  other.variance.resize(0, 0);
  CHECK(refusal({d, other}, {1.0, 2.0}) == "response 2 has no variance: what noise explains is not known");
  other = d;
  other.response_units = {"A"};
  CHECK(refusal({d, other}, {1.0, 2.0}) == "response 2 has other inputs, outputs or units than the first one");
}

TEST_CASE("spectrum.linearity: takes amplitudes from the spectra or as given, and sets the recommended one") {
  numerics::Random random(6);
  const ResponseData low = measured(random, 0.02), high = measured(random, 0.01, 0.3);
  for (const bool given : {false, true}) {
    BlockDriver<LinearityBlock> block;
    block.set("parameter", std::string("amplitude"));
    if (given) block.set("levels", std::vector<double>{40.0, 10.0});
    start(block);
    block.receive(with_spectra(high, 4.0), 0.0);
    block.receive(with_spectra(low, 1.0), 0.0);
    block.finish();
    REQUIRE(block.records().size() == 2);
    const RecordView r(*block.records()[0]), change(*block.records()[1]);
    CHECK(r.type() == "linearity");
    CHECK(r.boolean("linear").value() == false);
    CHECK(r.number("recommended_amplitude").value() == Approx(given ? 10.0 : 1.0));
    CHECK(r.array("amplitude")->unit == (given ? "" : "V"));
    CHECK(r.array("line_p_value")->shape.size() == 2);
    REQUIRE(r.texts("warnings")->size() == 1);
    CHECK(change.type() == "parameter_change");
    CHECK(change.text("parameter").value() == "amplitude");
    CHECK(change.number("value").value() == Approx(given ? 10.0 : 1.0));
  }
  CHECK(failure_of([&] {
          BlockDriver<LinearityBlock> block;
          start(block);
          block.receive(write_response(low), 0.0);
          block.finish();
        }) == "response 1: the response has no mean spectra to take its amplitude from; give `levels`");
}
