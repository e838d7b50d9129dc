#include "spectrum/local_polynomial_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catch.hpp"
#include "record_bytes.hpp"
#include "stream_signals.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using spectrum::LocalPolynomialBlock;
using Driver = BlockDriver<LocalPolynomialBlock>;

namespace {

const StreamFacts kInput = stream({"iq"}, "A"), kOutput = stream({"motor", "load"}, "rad/s"), kNone;

std::vector<Channels> signals(std::size_t samples) {
  const auto u = white_samples(samples, 1);
  auto a = lagged(u, 0.7);
  const auto noise = white_samples(samples, 2, 0.05);
  for (std::size_t n = 0; n < samples; ++n) a[n] += noise[n];
  return {{u}, {a, lagged(u, 0.5)}, {}};
}

template <class Prepare>
void start(Driver& block, const std::vector<StreamFacts>& facts, Prepare prepare) {
  prepare(block);
  block.configure();
  block.resolve(facts);
  block.activate(4096, Rate(1000, 1));
}

const auto kAsItIs = [](Driver&) {};

}  // namespace

TEST_CASE("local polynomial block: the record holds response, noise and transient levels") {
  Driver block;
  start(block, {kInput, kOutput, kNone}, [](Driver& b) {
    b.set("band", std::vector<double>{20.0, 200.0}).set("step", std::int64_t{4});
  });
  feed(block, signals(1000), 77);
  block.finish();
  REQUIRE(block.records().size() == 1);
  const RecordView r(*block.records()[0]);
  CHECK(r.text("form") == "local_polynomial");
  CHECK(r.text("method") == "spectrum.local_polynomial");
  CHECK(r.integer("samples") == 1000);
  CHECK(r.integer("half_width") == 6);
  CHECK(r.number("degrees_of_freedom") == 7.0);
  CHECK(r.integer("correlated_lines") == 3);  // 12 lines of the record, each fourth is estimated
  const auto samples = signals(1000);
  const auto [least, greatest] = std::minmax_element(samples[0][0].begin(), samples[0][0].end());
  CHECK(r.numbers("input_amplitude") == std::vector<double>{std::max(-*least, *greatest)});
  CHECK(warnings_of(r).empty());
  const auto frequency = r.array("frequency")->as<double>();
  REQUIRE(frequency.size() == 46);
  CHECK(frequency[1] == 24.0);
  CHECK(r.array("noise_level")->unit == "rad/s");
  CHECK(r.array("transient_level").has_value());
  const auto g = r.array("response")->as<std::complex<double>>();
  const auto radius = r.array("confidence_radius")->as<double>();
  int covered = 0;
  for (std::size_t k = 0; k < 46; ++k) {
    const auto q = std::polar(1.0, -6.283185307179586 * frequency[k] / 1000.0);
    covered += std::abs(g[2 * k] - 0.3 * q / (1.0 - 0.7 * q)) <= radius[2 * k] ? 1 : 0;
    CHECK(std::abs(g[2 * k + 1] - 0.5 * q / (1.0 - 0.5 * q)) < 1e-3);
    CHECK(r.array("noise_level")->as<double>()[2 * k] == Approx(0.05 / std::sqrt(1000.0)).epsilon(0.75));
  }
  CHECK(covered >= 38);
}

TEST_CASE("local polynomial block: the same record whatever the size of the calls") {
  const auto run = [](std::size_t chunk) {
    Driver block;
    start(block, {kInput, kOutput, kNone}, kAsItIs);
    feed(block, signals(500), chunk);
    block.finish();
    return bytes_of(block.records());
  };
  const auto expected = run(1);
  for (const std::size_t chunk : {7u, 64u, 500u}) CHECK(run(chunk) == expected);
}

TEST_CASE("local polynomial block: a reference makes it a closed-loop estimate") {
  Driver block;
  start(block, {kInput, kOutput, stream({"r"}, "A")}, kAsItIs);
  auto data = signals(1000);
  data[2] = data[0];
  const auto noise = white_samples(1000, 9, 0.1);
  for (std::size_t n = 0; n < 1000; ++n) data[0][0][n] += noise[n];
  feed(block, data, 250);
  block.finish();
  const RecordView r(*block.records()[0]);
  CHECK(r.text("form") == "reference");
  CHECK(r.texts("reference_names") == std::vector<std::string_view>{"r"});
  CHECK(warnings_of(r).empty());
  CHECK(r.array("response")->as<std::complex<double>>().size() == 499 * 2);
}

TEST_CASE("local polynomial block: warnings of narrow peaks, silent lines and weak references") {
  const auto warnings = [](std::vector<Channels> data, const StreamFacts& reference, auto prepare) {
    Driver block;
    start(block, {kInput, kOutput, reference}, prepare);
    feed(block, data, 500);
    block.finish();
    return warnings_of(RecordView(*block.records().back()));
  };
  auto data = signals(1000);
  auto& y = data[1][0];
  const double radius = std::exp(-0.01), cosine = std::cos(0.8);  // a mode of 3.2 Hz bandwidth at 127 Hz, lines each 1 Hz
  for (std::size_t n = 2; n < y.size(); ++n)
    y[n] = 2.0 * radius * cosine * y[n - 1] - radius * radius * y[n - 2] + 0.05 * data[0][0][n - 1];
  const auto peak = warnings(data, kNone, kAsItIs);
  REQUIRE(peak.size() == 1);
  CHECK(peak[0].find(
            "around the peak at 127 Hz the residuals are far above those beside it: the resonance is narrower than a fit of "
            "13 lines follows (13 Hz)") == 0);

  data = signals(1000);
  for (std::size_t n = 0; n < 1000; ++n) {
    data[0][0][n] = 0.0;
    for (int k = 100; k <= 200; ++k) data[0][0][n] += std::cos(6.283185307179586e-3 * k * static_cast<double>(n) + 0.1 * k * k);
  }
  data[1][0] = data[1][1] = data[0][0];
  const auto silent = warnings(data, kNone, kAsItIs);
  REQUIRE(silent.size() == 1);
  CHECK(silent[0].find(" lines between 1 and 499 Hz left out: the input is silent or too smooth there") != std::string::npos);

  data = signals(1000);
  data[2] = {white_samples(1000, 55)};
  for (std::size_t n = 0; n < 1000; ++n) data[0][0][n] += 0.3 * data[2][0][n];
  CHECK(warnings(data, stream({"r"}, "A"), kAsItIs)[0].find("what the reference causes at the input is only ") == 0);
}

TEST_CASE("local polynomial block: what cannot be measured is refused by name") {
  const auto refusal = [](std::vector<StreamFacts> facts, auto prepare) {
    Driver block;
    return failure_of([&] { start(block, facts, prepare); });
  };
  CHECK(refusal({kInput, kOutput, kNone}, kAsItIs) == "no failure");
  CHECK(refusal({kInput, kOutput, stream({"a", "b"}, "A")}, kAsItIs) == "'reference' has 2 channels, 'input' 1; needed: as many");
  CHECK(refusal({kInput, kOutput, kNone}, [](Driver& b) { b.set("half_width", std::int64_t{2}); }) ==
        "half_width 2 gives 5 lines for 6 unknowns; needed: at least 3");
  CHECK(refusal({stream({"iq"}, "A", 20), stream({"y"}, "V", 20), kNone}, kAsItIs) ==
        "the record has 20 samples; needed: at least 27, a fit takes 13 lines");
  CHECK(refusal({stream({"iq"}, "A", 200), stream({"y"}, "V", 200), kNone}, [](Driver& b) {
          b.set("limit", std::int64_t{100});
        }) == "the record has more samples than limit, 100; measure shorter, decimate, or raise limit");
  CHECK(refusal({stream({"iq"}, "A", 4000004), stream({"y"}, "V", 4000004), kNone}, kAsItIs) ==
        "the band has 2000001 lines, at most 1000000 are estimated; give a smaller band or a step of 3");

  Driver block;
  start(block, {kInput, kOutput, kNone}, [](Driver& b) { b.set("limit", std::int64_t{300}); });
  CHECK(failure_of([&] { feed(block, signals(400), 64); }) ==
        "the record has more samples than limit, 300; measure shorter, decimate, or raise limit");
  block.reset();
  auto data = signals(300);
  data[0][0][123] = -std::numeric_limits<double>::infinity();
  CHECK(failure_of([&] { feed(block, data, 50); }) == "input 'iq': sample 123 is infinite");
  block.reset();
  data = signals(300);
  data[0][0].assign(300, 1.0);
  feed(block, data, 50);
  CHECK(failure_of([&] { block.finish(); }) == "input 'iq' is constant: it excites nothing");
  block.reset();
  feed(block, signals(20), 20);
  CHECK(failure_of([&] { block.finish(); }) == "the record has 20 samples; needed: at least 27, a fit takes 13 lines");
}

TEST_CASE("local polynomial block: advice tells the width of a fit and warns of periods") {
  Driver block;
  block.configure();
  StreamFacts u = stream({"iq"}, "A", 10000), y = stream({"y"}, "V", 10000);
  u.notes["excitation.period"] = {2.0};
  const auto said = block.advise({u, y, kNone});
  REQUIRE(said.size() == 2);
  CHECK(said[0] ==
        "a fit takes 13 lines and leaves 7 degrees of freedom (95 % radius 1.12 times that of a known variance); lines each 0.1 "
        "Hz in "
        "10 s: resonances with a 3 dB bandwidth below 1.8 Hz are flattened");
  CHECK(said[1].find("warning: the excitation repeats each 2 s: spectrum.averaging_dft") == 0);
}
