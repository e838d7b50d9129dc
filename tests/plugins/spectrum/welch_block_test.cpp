#include "spectrum/welch_block.hpp"

#include <cmath>
#include <limits>

#include "catch.hpp"
#include "record_bytes.hpp"
#include "spectrum/sample_watch.hpp"
#include "stream_signals.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using spectrum::SampleWatch;
using spectrum::WelchBlock;
using Driver = BlockDriver<WelchBlock>;

namespace {

const std::vector<StreamFacts> kFacts = {stream({"iq"}, "A"), stream({"motor", "load"}, "rad/s")};

std::vector<Channels> signals(std::size_t samples) {
  const auto u = white_samples(samples, 1);
  auto a = lagged(u, 0.3), b = lagged(u, 0.6);
  const auto noise = white_samples(samples, 2, 0.05);
  for (std::size_t n = 0; n < samples; ++n) a[n] += noise[n];
  return {{u}, {a, b}};
}

template <class Prepare>
void start(Driver& block, const std::vector<StreamFacts>& facts, Prepare prepare) {
  block.set("segment", std::int64_t{100});
  prepare(block);
  block.configure();
  block.resolve(facts);
  block.activate(4096, Rate(1000, 1));
}

const auto kAsItIs = [](Driver&) {};

}  // namespace

TEST_CASE("welch block: the record holds response, coherence and densities") {
  Driver block;
  start(block, kFacts, [](Driver& b) { b.set("band", std::vector<double>{50.0, 300.0}); });
  feed(block, signals(4096), 333);
  block.finish();
  REQUIRE(block.records().size() == 1);
  const RecordView r(*block.records()[0]);
  CHECK(r.type() == "frequency_response");
  CHECK(r.text("form") == "h1");
  CHECK(r.text("method") == "spectrum.welch");
  CHECK(r.integer("segment") == 100);
  CHECK(r.integer("hop") == 50);
  CHECK(r.integer("averages") == 80);
  CHECK(r.number("resolution") == Approx(15.0));
  CHECK(r.number("effective_averages") == Approx(80.0 / (1.0 + 2.0 / 36.0)).epsilon(0.002));
  CHECK(*r.number("degrees_of_freedom") == Approx(*r.number("effective_averages") - 1.0));
  CHECK(r.texts("response_units") == std::vector<std::string_view>{"rad/s/A", "rad/s/A"});
  CHECK(r.integer("correlated_lines") == 2);
  REQUIRE(r.numbers("input_amplitude"));
  CHECK(r.numbers("input_amplitude")->size() == 1);
  CHECK(warnings_of(r).empty());
  const auto frequency = r.array("frequency")->as<double>();
  REQUIRE(frequency.size() == 26);
  CHECK(frequency.front() == 50.0);
  CHECK(frequency.back() == 300.0);
  CHECK(r.array("line")->as<std::int64_t>()[0] == 5);
  CHECK(r.array("input_density")->unit == "A^2/Hz");
  CHECK(r.array("output_density")->unit == "(rad/s)^2/Hz");
  const auto shape = r.array("coherence")->shape;
  CHECK(std::vector<std::uint64_t>(shape.begin(), shape.end()) == std::vector<std::uint64_t>{26, 2});
  const auto g = r.array("response")->as<std::complex<double>>();
  const auto radius = r.array("confidence_radius")->as<double>();
  for (std::size_t k = 0; k < 26; ++k) {
    const auto q = std::polar(1.0, -6.283185307179586 * frequency[k] / 1000.0);
    CHECK(std::abs(g[2 * k] - 0.7 * q / (1.0 - 0.3 * q)) < 3.0 * radius[2 * k] + 0.02);
    CHECK(std::abs(g[2 * k + 1] - 0.4 * q / (1.0 - 0.6 * q)) < 3.0 * radius[2 * k + 1] + 0.02);
  }
}

TEST_CASE("welch block: the same records at the same places whatever the size of the calls") {
  const auto run = [](std::size_t chunk) {
    Driver block;
    start(block, kFacts, [](Driver& b) { b.set("every", std::int64_t{7}).set("overlap", 0.6).set("detrend", "linear"); });
    feed(block, signals(1000), chunk);
    block.finish();
    return std::make_pair(bytes_of(block.records()), block.record_positions());
  };
  const auto expected = run(1);
  CHECK(expected.second == std::vector<std::uint64_t>{340, 620, 900, 1000});
  for (const std::size_t chunk : {7u, 40u, 100u, 256u, 1000u}) CHECK(run(chunk) == expected);
}

TEST_CASE("welch block: warnings name what spoils the estimate") {
  const auto warnings = [](std::vector<Channels> data, auto prepare) {
    Driver block;
    start(block, kFacts, prepare);
    feed(block, data, 500);
    block.finish();
    return warnings_of(RecordView(*block.records().back()));
  };
  auto data = signals(500);
  const auto few = warnings(data, kAsItIs);
  REQUIRE(few.size() == 1);
  CHECK(few[0] ==
        "9 segments are worth 8.6 averages: response, variance and coherence are rough below 10; measure longer or take shorter "
        "segments");
  data = signals(4000);
  data[1][1] = white_samples(4000, 77);
  const auto noisy = warnings(data, kAsItIs);
  REQUIRE(noisy.size() == 1);
  CHECK(noisy[0].find("the coherence of output 'load' is below 0.5 at 49 of 49 lines (median 0.0") == 0);
  data = signals(4000);
  for (double& x : data[0][0]) x = std::clamp(x, -1.5, 1.5);
  const auto clipped = warnings(data, kAsItIs);
  REQUIRE(!clipped.empty());
  CHECK(clipped[0].find("input 'iq' has its greatest value 1.5 in ") == 0);
  CHECK(clipped[0].find(" % of its samples and least value -1.5 in ") != std::string::npos);
  data = signals(20000);
  auto& y = data[1][0];
  const double radius = std::exp(-0.01), cosine = std::cos(0.8);  // a mode of 3.2 Hz bandwidth at 127 Hz, lines each 10 Hz
  for (std::size_t n = 2; n < y.size(); ++n)
    y[n] = 2.0 * radius * cosine * y[n - 1] - radius * radius * y[n - 2] + 0.05 * data[0][0][n - 1];
  const auto peak = warnings(data, kAsItIs);
  REQUIRE(peak.size() == 1);
  CHECK(peak[0].find("the peak at 130 Hz is ") == 0);
  CHECK(peak[0].find("lines wide (3 dB), needed: 4") != std::string::npos);
}

TEST_CASE("welch block: what cannot be measured is refused by name") {
  const auto refusal = [](std::vector<StreamFacts> facts, auto prepare) {
    Driver block;
    return failure_of([&] { start(block, facts, prepare); });
  };
  CHECK(refusal(kFacts, kAsItIs) == "no failure");
  CHECK(refusal({stream({"a", "b"}, "A"), kFacts[1]}, [](Driver& b) { b.set("form", "h2"); }) ==
        "form h2 takes one input, 'input' has 2 channels; use h1");
  CHECK(refusal({stream({"iq"}, "A", 149), stream({"motor"}, "rad", 149)}, kAsItIs) ==
        "the input has 149 samples, 1 segment of 100; needed: more than 1, one an input");
  CHECK(refusal(kFacts, [](Driver& b) { b.set("band", std::vector<double>{10.0}); }) == "band has 1 value; needed: [from, to]");
  CHECK(refusal(kFacts, [](Driver& b) {
          b.set("band", std::vector<double>{10.0, 500.0});
        }) == "band [10 Hz, 500 Hz] reaches the Nyquist frequency 500 Hz");
  CHECK(refusal(kFacts, [](Driver& b) {
          b.set("band", std::vector<double>{11.0, 19.0});
        }) == "band [11 Hz, 19 Hz] holds no line; they are multiples of 10 Hz");
  CHECK(refusal(kFacts, [](Driver& b) {
          b.set("band", std::vector<double>{30.0, 20.0});
        }) == "band [30 Hz, 20 Hz] does not rise");
  StreamFacts other = kFacts[1];
  other.clock = "card";
  CHECK(refusal({kFacts[0], other}, kAsItIs) ==
        "inputs 'input' and 'output' have the clock domains '' and 'card'; a spectrum needs one clock");

  Driver block;
  start(block, kFacts, kAsItIs);
  auto data = signals(300);
  data[1][1][211] = std::numeric_limits<double>::quiet_NaN();
  CHECK(failure_of([&] { feed(block, data, 64); }) == "output 'load': sample 211 is not a number");
  block.reset();
  data = signals(300);
  data[0][0].assign(300, 2.5);
  feed(block, data, 300);
  CHECK(failure_of([&] { block.finish(); }) == "input 'iq' is constant: it excites nothing");
}

TEST_CASE("welch block: advice tells averages, resolution and random error, and warns of leakage and periods") {
  const auto advice = [](StreamFacts u, StreamFacts y) {
    Driver block;
    block.set("segment", std::int64_t{100});
    block.configure();
    return block.advise({u, y});
  };
  StreamFacts u = stream({"iq"}, "A", 10000), y = stream({"motor"}, "rad", 10000);
  const auto plain = advice(u, y);
  REQUIRE(plain.size() == 1);
  // 199 segments, M_e = 188.6: sqrt(0.1 / (1.8 * 187.6)) = 1.7 %.
  CHECK(plain[0] ==
        "199 segments in 10 s, worth 189 averages; resolution 15 Hz (lines each 10 Hz); random error of |G| 1.7 % at a coherence "
        "of 0.9");
  y.notes["plant.settling_time"] = {0.3};
  u.notes["excitation.period"] = {1.0};
  const auto warned = advice(u, y);
  REQUIRE(warned.size() == 3);
  CHECK(warned[1] ==
        "warning: the excitation repeats each 1 s: spectrum.averaging_dft over whole periods has no leakage and needs no window");
  CHECK(warned[2] ==
        "warning: leakage: a segment lasts 0.1 s, the plant needs 0.3 s to settle; take segments of 600 samples or more, or "
        "spectrum.local_polynomial");
  const auto few = advice(stream({"iq"}, "A", 300), stream({"motor"}, "rad", 300));
  REQUIRE(few.size() == 2);
  CHECK(few[1] == "warning: few averages (4.8): measure 3 times as long, or take shorter segments");
}

TEST_CASE("sample watch: tells clipped signals from binary, held, periodic, quantised and resting ones") {
  const auto clipping = [](const std::vector<double>& x) {
    SampleWatch watch;
    CHECK(watch.add(x) == x.size());
    return watch.clipping("u");
  };
  const auto noise = white_samples(3000, 5);
  auto clipped = noise, binary = noise, held = noise, coarse = noise, sine = noise, rest = noise;
  for (double& x : clipped) x = std::min(x, 1.9);
  for (double& x : binary) x = x > -1.5 ? 1.0 : -1.0;
  for (double& x : coarse) x = std::round(10.0 * x);
  for (std::size_t n = 0; n < noise.size(); ++n) {
    held[n] = noise[n % 600 / 10];
    sine[n] = std::round(2000.0 * std::sin(0.01 * static_cast<double>(n)));
    rest[n] = n < 500 ? 0.0 : 1.0 + noise[n] * noise[n];
  }
  CHECK(clipping(noise).empty());
  CHECK(clipping(binary).empty());
  CHECK(clipping(coarse).empty());
  CHECK(clipping(held).empty());
  CHECK(clipping(sine).empty());
  CHECK(clipping(rest).empty());
  CHECK(clipping(clipped).find("u has its greatest value 1.9 in ") == 0);
  SampleWatch watch;
  CHECK(watch.add(std::vector<double>(10, 3.0)) == 10);
  CHECK(watch.constant());
  CHECK(watch.add(std::vector<double>{1.0, std::numeric_limits<double>::infinity(), 2.0}) == 1);
  CHECK_FALSE(watch.constant());
}
