#include "spectrum/stepped_sine_block.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "catch.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using bodeflow::test::BlockDriver;
using bodeflow::test::Channels;
using bodeflow::test::failure_of;
using spectrum::SteppedSineBlock;
using Driver = BlockDriver<SteppedSineBlock>;
using Complex = std::complex<double>;

namespace {

constexpr std::size_t kSilence = 200, kDwell = 600, kLength = kSilence + 2 * kDwell;
constexpr double kSigma = 0.01;
/// 50 Hz and 120 Hz at 1 kHz.
constexpr std::int64_t kCycles[] = {1, 3}, kWindow[] = {20, 25};

StreamFacts facts(int channels, const char* unit) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate(1000, 1);
  f.unit = unit;
  return f;
}

RecordBuilder frequency_step(std::int64_t index, double sample_rate = 1000.0) {
  RecordBuilder r("frequency_step");
  r.set("index", index);
  r.set("count", std::int64_t{2});
  r.set("cycles", kCycles[index]);
  r.set("window", kWindow[index]);
  r.set("sample_rate", sample_rate);
  return r;
}

/// Silence, then each frequency: outputs of an amplifier of -3 and of a lag y[n] = 0.9 y[n-1] + 0.1 u[n-1], with noise.
std::vector<Channels> signals() {
  numerics::Random random(4);
  std::vector<Channels> s{Channels(1), Channels(2)};
  double lag = 0.0;
  for (std::size_t n = 0; n < kLength; ++n) {
    const std::size_t i = n < kSilence + kDwell ? 0 : 1, since = n - kSilence - i * kDwell;
    const double turned = static_cast<double>(kCycles[i]) * static_cast<double>(since) / static_cast<double>(kWindow[i]);
    const double u = n < kSilence ? 0.0 : std::sin(2.0 * std::numbers::pi * turned);
    s[0][0].push_back(u);
    s[1][0].push_back(-3.0 * u + kSigma * random.normal());
    s[1][1].push_back(lag + kSigma * random.normal());
    lag = 0.9 * lag + 0.1 * u;
  }
  return s;
}

std::vector<Complex> truth(std::size_t frequency) {
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(kCycles[frequency]) / static_cast<double>(kWindow[frequency]);
  return {-3.0, 0.1 / (std::polar(1.0, angle) - 0.9)};
}

void start(Driver& block) {
  block.configure();
  block.resolve({facts(1, "A"), facts(2, "V")});
  block.activate(kLength, Rate(1000, 1));
}

/// Samples from..to of the signals in calls of up to `chunk`.
void feed(Driver& block, const std::vector<Channels>& all, std::size_t from, std::size_t to, std::size_t chunk) {
  for (std::size_t n = from; n < to; n += chunk) {
    const std::size_t count = std::min(chunk, to - n);
    std::vector<Channels> part = all;
    for (Channels& port : part) {
      for (auto& c : port) c = {c.begin() + static_cast<std::ptrdiff_t>(n), c.begin() + static_cast<std::ptrdiff_t>(n + count)};
    }
    block.process(part, count);
  }
}

/// The whole experiment.
void measure(Driver& block, const std::vector<Channels>& all, std::size_t chunk = kLength) {
  start(block);
  feed(block, all, 0, kSilence, chunk);
  block.receive(frequency_step(0), 0.2);
  feed(block, all, kSilence, kSilence + kDwell, chunk);
  block.receive(frequency_step(1), 0.8);
  feed(block, all, kSilence + kDwell, kLength, chunk);
  block.finish();
}

std::vector<std::string> warnings(const Driver& block) {
  const auto all = RecordView(*block.records().back()).texts("warnings").value();
  return {all.begin(), all.end()};
}

}  // namespace

TEST_CASE("stepped sine: each frequency is left when it has settled, and the record holds the responses") {
  Driver block;
  measure(block, signals());
  REQUIRE(block.records().size() == 3);
  for (std::int64_t i = 0; i < 2; ++i) {
    const RecordView step(*block.records()[static_cast<std::size_t>(i)]);
    CHECK(step.type() == "frequency_step");
    CHECK(step.integer("index") == i);
  }
  const RecordView r(*block.records()[2]);
  CHECK(r.type() == "frequency_response");
  CHECK(r.text("form") == "stepped_sine");
  CHECK(r.text("method") == "spectrum.stepped_sine");
  CHECK(r.texts("response_units").value()[1] == "V/A");
  CHECK(warnings(block).empty());
  const auto shape = r.array("response")->shape;
  CHECK(std::vector<std::uint64_t>(shape.begin(), shape.end()) == std::vector<std::uint64_t>{2, 2, 1});
  const auto f = r.array("frequency")->as<double>();
  CHECK(std::vector<double>(f.begin(), f.end()) == std::vector<double>{50.0, 120.0});
  for (std::size_t k = 0; k < 2; ++k) {
    const auto windows = r.array("windows")->as<std::int64_t>()[k];
    CHECK(windows >= 4);
    CHECK(r.array("settled")->as<std::int64_t>()[k] == 1);
    const double dwell = r.array("dwell")->as<double>()[k], settled_after = r.array("settled_after")->as<double>()[k];
    CHECK(dwell < 0.3);
    CHECK(dwell >= settled_after + 4e-3 * static_cast<double>(kWindow[k]));
    const auto position = kSilence + k * kDwell + static_cast<std::size_t>(std::lround(1000.0 * dwell));
    CHECK(block.record_positions()[k] == position);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto at = 2 * k + i;
      const double error = std::abs(r.array("response")->as<Complex>()[at] - truth(k)[i]);
      const double deviation = std::sqrt(4.0 * kSigma * kSigma / static_cast<double>(windows * kWindow[k]));
      CHECK(error < 4.0 * deviation);
      CHECK(r.array("variance")->as<double>()[at] < 9.0 * deviation * deviation);
      CHECK(r.array("confidence_radius")->as<double>()[at] > std::sqrt(r.array("variance")->as<double>()[at]));
    }
  }
}

TEST_CASE("stepped sine: records and their positions are equal bit for bit whatever the size of the calls") {
  const auto all = signals();
  const auto run = [&](std::size_t chunk) {
    Driver block;
    block.set("each", true);
    measure(block, all, chunk);
    std::vector<std::pair<std::uint64_t, std::vector<std::uint8_t>>> sent;
    for (std::size_t i = 0; i < block.records().size(); ++i) {
      const bf_record& r = *block.records()[i];
      sent.emplace_back(block.record_positions()[i], std::vector<std::uint8_t>(r.bytes, r.bytes + r.size));
    }
    return sent;
  };
  const auto expected = run(kLength);
  CHECK(expected.size() == 5);
  for (const std::size_t chunk : {1u, 7u, 64u, 500u}) CHECK(run(chunk) == expected);
}

TEST_CASE("stepped sine: the settled time asked for and the number of windows both hold") {
  Driver block;
  block.set("windows", std::int64_t{3}).set("settled_time", 0.25).set("noise", std::vector<double>{kSigma});
  measure(block, signals());
  const RecordView r(*block.records().back());
  for (std::size_t k = 0; k < 2; ++k) CHECK(r.array("windows")->as<std::int64_t>()[k] * kWindow[k] >= 250);
}

TEST_CASE("stepped sine: repeat waits until successive windows agree") {
  Driver block;
  block.set("settling", std::string("repeat")).set("tolerance", 0.05);
  measure(block, signals());
  const RecordView r(*block.records().back());
  REQUIRE(block.records().size() == 3);
  for (std::size_t at = 0; at < 4; ++at) CHECK(std::abs(r.array("response")->as<Complex>()[at] - truth(at / 2)[at % 2]) < 0.02);
}

TEST_CASE("stepped sine: a plant that never settles is left after max_time, with a warning") {
  auto all = signals();
  for (std::size_t n = 0; n < kLength; ++n) all[1][1][n] *= 1.0 + 0.01 * static_cast<double>(n);
  Driver block;
  block.set("max_time", 0.4).set("noise", std::vector<double>{kSigma, kSigma});
  measure(block, all);
  const RecordView r(*block.records().back());
  CHECK(r.array("settled")->as<std::int64_t>()[0] == 0);
  CHECK(r.array("dwell")->as<double>()[0] == 0.4);
  CHECK(r.array("windows")->as<std::int64_t>()[0] == 4);
  REQUIRE(warnings(block).size() == 1);
  CHECK(warnings(block)[0] ==
        "2 of 2 frequencies (50 Hz, 120 Hz) had not settled when their time was over, and are biased by the transient: raise "
        "max_time (or the generator's dwell)");
}

TEST_CASE("stepped sine: where the generator goes on by itself all settled windows of its dwell count") {
  Driver block;
  block.set("advance", false);
  measure(block, signals());
  const RecordView r(*block.records().back());
  REQUIRE(block.records().size() == 1);
  CHECK(warnings(block).empty());
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(r.array("dwell")->as<double>()[k] == 0.6);
    const auto after = std::lround(1000.0 * r.array("settled_after")->as<double>()[k]);
    CHECK(after > 0);
    CHECK(after < 100);
    CHECK(r.array("windows")->as<std::int64_t>()[k] == (600 - after) / kWindow[k]);
  }
}

TEST_CASE("stepped sine: small signals and missing frequencies are warned of") {
  auto all = signals();
  for (std::size_t n = 0; n < kLength; ++n) all[1][0][n] += 3.0 * (1.0 - 1e-3) * all[0][0][n];  // leaves 0.003 of 0.01 noise
  Driver block;
  start(block);
  feed(block, all, 0, kSilence, kLength);
  block.receive(frequency_step(0), 0.2);
  feed(block, all, kSilence, kSilence + kDwell, kLength);
  block.finish();
  CHECK(warnings(block) == std::vector<std::string>{"output 'output_1' stands less than 10 dB above its noise at 1 of 1 "
                                                    "frequency (50 Hz): raise the amplitude or the windows",
                                                    "1 of 2 frequencies were measured before the run ended: raise its duration"});
}

TEST_CASE("stepped sine: two and three windows are enough for a variance, with a warning") {
  Driver block;
  block.set("windows", std::int64_t{2}).set("settled_time", 0.06);  // 3 of 20 ms, 3 of 25 ms
  measure(block, signals());
  CHECK(RecordView(*block.records().back()).number("degrees_of_freedom") == 2.0);
  CHECK(warnings(block) ==
        std::vector<std::string>{"fewer than 4 windows at 2 of 2 frequencies (50 Hz, 120 Hz) give a variance that is "
                                 "itself uncertain: raise windows"});
}

TEST_CASE("stepped sine: streams at another rate than the generator's have windows of their own") {
  for (const double generator_rate : {500.0, 2000.0, 3000.0}) {
    Driver block;
    block.set("noise", std::vector<double>{kSigma}).set("settling", std::string("repeat")).set("tolerance", 0.5);
    start(block);
    block.receive(frequency_step(0, generator_rate), 0.0);  // rate / 20
    std::vector<Channels> all{Channels(1), Channels(2)};
    for (int n = 0; n < 600; ++n) {
      const double u = std::cos(2.0 * std::numbers::pi * generator_rate / 20.0 / 1000.0 * n);
      all[0][0].push_back(u);
      all[1][0].push_back(2.0 * u);
      all[1][1].push_back(-u);
    }
    block.process(all, 600);
    block.finish();
    const RecordView r(*block.records().back());
    CHECK(r.array("frequency")->as<double>()[0] == Approx(generator_rate / 20.0));
    CHECK(static_cast<double>(r.array("cycles")->as<std::int64_t>()[0]) * 1000.0 /
              static_cast<double>(r.array("window")->as<std::int64_t>()[0]) ==
          Approx(generator_rate / 20.0));
    CHECK(std::abs(r.array("response")->as<Complex>()[0] - 2.0) < 1e-12);
  }
}

TEST_CASE("stepped sine: what cannot be measured ends the run by name") {
  const auto all = signals();
  const auto refusal = [&](auto prepare, auto work) {
    Driver block;
    prepare(block);
    start(block);
    return failure_of([&] { work(block); });
  };
  const auto nothing = [](Driver&) {};
  CHECK(refusal(nothing, [](Driver& b) { b.finish(); }) ==
        "no frequency was measured: no record came on 'started'; connect it to generators.stepped_sine");
  CHECK(refusal(nothing, [](Driver& b) { b.receive(frequency_step(0), 0.0); }) ==
        "the noise of the outputs is not known: give 'noise', or let the generator be silent for at least 100 samples first; "
        "found: 0");
  CHECK(refusal(nothing, [](Driver& b) { b.receive(RecordBuilder("model"), 0.0); }) ==
        "a record of type 'model' on 'started'; needed: frequency_step with index, count, cycles, window and sample_rate, as "
        "generators.stepped_sine sends");
  const auto silent = [](Driver& b) {
    b.process({Channels(1, std::vector<double>(150)), Channels(2, std::vector<double>(150, 7.0))}, 150);
    b.receive(frequency_step(0), 0.15);
  };
  CHECK(refusal(nothing, silent) ==
        "output 'output_1' has no noise before the first frequency: without noise use settling: repeat");
  const auto noise = [](Driver& b) { b.set("noise", std::vector<double>{1.0}); };
  const auto zero = [](Driver& b) {
    b.receive(frequency_step(0), 0.0);
    b.process({Channels(1, std::vector<double>(150)), Channels(2, std::vector<double>(150))}, 150);
  };
  CHECK(refusal(noise, zero) == "frequency 50 Hz: the input is zero");
  const auto broken = [&](Driver& b) {
    auto bad = all;
    bad[1][1][77] = std::numeric_limits<double>::quiet_NaN();
    b.process(bad, kLength);
  };
  CHECK(refusal(noise, broken) == "output 'output_2': sample 77 is not a number");
  const auto beyond = [](Driver& b) { b.receive(frequency_step(1, 5000.0), 0.0); };  // 600 Hz at 1 kHz
  CHECK(refusal(noise, beyond) ==
        "frequency 600 Hz has no whole window below half of the sample rate of 1000 Hz and 100000000 samples");
}

TEST_CASE("stepped sine: settings that do not fit are refused") {
  const auto refusal = [](auto prepare) {
    Driver block;
    prepare(block);
    return failure_of([&] { start(block); });
  };
  CHECK(refusal([](Driver& b) { b.set("noise", std::vector<double>{0.0}); }) == "noise is 0, allowed: above 0");
  CHECK(refusal([](Driver& b) {
          b.set("noise", std::vector<double>{1, 1, 1});
        }) == "noise has 3 values, allowed: 1, or one for each of the 2 outputs");
  CHECK(refusal([](Driver& b) { b.set("max_time", 1.0).set("settled_time", 2.0); }) == "max_time 1 s is below settled_time 2 s");
}

TEST_CASE("stepped sine: the settling time of the plant is held against the settings before the run") {
  StreamFacts y = facts(2, "V");
  y.notes["plant.settling_time"] = {5.0};
  const auto advice = [&](double settled_time, double max_time) {
    Driver block;
    block.set("settled_time", settled_time).set("max_time", max_time);
    block.configure();
    return block.advise({facts(1, "A"), y});
  };
  CHECK(advice(1.0, 6.0).empty());
  CHECK(advice(1.0, 3.0) ==
        std::vector<std::string>{"warning: the plant settles in 5 s, max_time is 3 s: responses will be taken "
                                 "before that; raise max_time"});
  CHECK(advice(0.1, 6.0) ==
        std::vector<std::string>{"settled_time 0.1 s is short of the plant's slowest time constant, 1 s: at high frequencies a "
                                 "slow transient may pass for settled; raise settled_time"});
}
