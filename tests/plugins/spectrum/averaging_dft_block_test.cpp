#include "spectrum/averaging_dft_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "catch.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using spectrum::AveragingDftBlock;
using test::BlockDriver;
using test::Channels;
using test::failure_of;

namespace {

constexpr int kPeriod = 50;

StreamFacts facts(int channels, const char* unit, std::vector<std::string> names, std::int64_t length = -1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate(1000, 1);
  f.length = length;
  f.unit = unit;
  f.channel_names = std::move(names);
  f.channel_units.assign(static_cast<std::size_t>(channels), unit);
  return f;
}

/// Input with lines 3, 5, 7; outputs 2 u and -u, with noise.
std::vector<Channels> signals(int samples) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<Channels> s{Channels(1), Channels(2)};
  for (int n = 0; n < samples; ++n) {
    double u = 0.0;
    for (const int k : {3, 5, 7}) u += std::cos(6.283185307179586 * k * n / kPeriod + k);
    s[0][0].push_back(u + noise(random));
    s[1][0].push_back(2.0 * u + noise(random));
    s[1][1].push_back(-u + noise(random));
  }
  return s;
}

std::vector<Channels> part(const std::vector<Channels>& s, std::size_t from, std::size_t count) {
  std::vector<Channels> p = s;
  for (auto& port : p) {
    for (auto& c : port)
      c = {c.begin() + static_cast<std::ptrdiff_t>(from), c.begin() + static_cast<std::ptrdiff_t>(from + count)};
  }
  return p;
}

using Sent = std::vector<std::pair<std::uint64_t, std::vector<std::uint8_t>>>;

template <class Prepare>
Sent run(int samples, std::size_t chunk, Prepare prepare) {
  BlockDriver<AveragingDftBlock> block;
  block.set("period", std::int64_t{kPeriod});
  prepare(block);
  block.configure();
  block.resolve({facts(1, "A", {"iq"}), facts(2, "rad", {"motor", "load"}), {}});
  block.activate(chunk, Rate(1000, 1));
  const auto all = signals(samples);
  for (std::size_t n = 0; n < static_cast<std::size_t>(samples); n += chunk) {
    const std::size_t count = std::min(chunk, static_cast<std::size_t>(samples) - n);
    block.process(part(all, n, count), count);
  }
  block.finish();
  Sent sent;
  for (std::size_t i = 0; i < block.records().size(); ++i) {
    const bf_record& r = *block.records()[i];
    if (RecordView(r.bytes).type() != "frequency_response") continue;
    sent.emplace_back(block.record_positions()[i], std::vector<std::uint8_t>(r.bytes, r.bytes + r.size));
  }
  return sent;
}

/// The record's bytes where a view may read them.
struct Aligned {
  explicit Aligned(const std::vector<std::uint8_t>& bytes)
      : data(static_cast<std::uint8_t*>(std::aligned_alloc(64, bytes.size()))) {
    std::memcpy(data, bytes.data(), bytes.size());
  }
  ~Aligned() { std::free(data); }
  Aligned(const Aligned&) = delete;
  Aligned& operator=(const Aligned&) = delete;
  std::uint8_t* data;
};

std::string refusal_of_lines(void (*prepare)(BlockDriver<AveragingDftBlock>&)) {
  BlockDriver<AveragingDftBlock> block;
  block.set("period", std::int64_t{kPeriod});
  prepare(block);
  return failure_of([&] { block.configure(); });
}

}  // namespace

TEST_CASE("averaging_dft: the record holds the response and what it was made from") {
  const Sent sent = run(7 * kPeriod + 20, 33, [](auto& b) { b.set("skip", std::int64_t{2}); });
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].first == 7 * kPeriod + 20);
  const Aligned bytes(sent[0].second);
  const RecordView r(bytes.data);
  CHECK(r.type() == "frequency_response");
  CHECK(r.text("form") == "errors_in_variables");
  CHECK(r.integer("periods") == 5);
  CHECK(r.integer("realisations") == 1);
  CHECK(r.integer("period") == kPeriod);
  CHECK(r.number("sample_rate") == 1000.0);
  CHECK(r.integer("dropped_samples") == 2 * kPeriod + 20);
  const auto averaged = part(signals(7 * kPeriod + 20), 2 * kPeriod, 5 * kPeriod);  // two periods are skipped
  double largest = 0.0;
  for (const double u : averaged[0][0]) largest = std::max(largest, std::abs(u));
  CHECK(r.numbers("input_amplitude") == std::vector<double>{largest});
  CHECK(r.integer("correlated_lines") == 0);
  CHECK(r.texts("output_names") == std::vector<std::string_view>{"motor", "load"});
  const auto frequency = r.array("frequency")->as<double>();
  CHECK(std::vector<double>(frequency.begin(), frequency.end()) == std::vector<double>{60.0, 100.0, 140.0});
  const auto response = *r.array("response");
  CHECK(response.unit == "rad/A");
  CHECK(std::vector<std::uint64_t>(response.shape.begin(), response.shape.end()) == std::vector<std::uint64_t>{3, 2, 1});
  CHECK(r.array("variance")->unit == "(rad/A)^2");
  const auto variance = r.array("variance")->as<double>();
  for (std::size_t k = 0; k < 6; ++k) {
    const double truth = k % 2 == 0 ? 2.0 : -1.0;
    CHECK(variance[k] > 0.0);
    CHECK(std::norm(response.as<std::complex<double>>()[k] - truth) < 20.0 * variance[k]);
  }
}

TEST_CASE("averaging_dft: records and their positions are equal bit for bit whatever the size of the calls") {
  const auto prepare = [](auto& b) { b.set("every", std::int64_t{2}).set("lines.list", std::vector<std::int64_t>{3, 5, 7}); };
  const Sent expected = run(7 * kPeriod + 3, 1, prepare);
  REQUIRE(expected.size() == 4);
  CHECK(expected[0].first == 2 * kPeriod);
  CHECK(expected[1].first == 4 * kPeriod);
  CHECK(expected[3].first == 7 * kPeriod + 3);
  for (const std::size_t chunk : {7u, 50u, 64u, 99u, 353u}) CHECK(run(7 * kPeriod + 3, chunk, prepare) == expected);
}

TEST_CASE("averaging_dft: no second record for the same periods at the end") {
  CHECK(run(4 * kPeriod, 64, [](auto& b) { b.set("every", std::int64_t{2}); }).size() == 2);
}

TEST_CASE("averaging_dft: signals that cannot be measured are refused by name") {
  const auto refusal = [](std::vector<StreamFacts> inputs) {
    inputs.emplace_back();  // no reference
    BlockDriver<AveragingDftBlock> block;
    block.set("period", std::int64_t{kPeriod}).set("skip", std::int64_t{1});
    block.configure();
    return failure_of([&] { block.resolve(inputs); });
  };
  const StreamFacts u = facts(1, "A", {"iq"}), y = facts(1, "rad", {"motor"});
  StreamFacts no_rate = u, other_clock = y;
  no_rate.rate = {};
  other_clock.clock = "card";
  CHECK(refusal({u, y}) == "no failure");
  CHECK(refusal({facts(3, "A", {"a", "b", "c"}), y}) ==
        "3 experiments (realisations 1 x experiments 3) need `periods`: how many are averaged in each");
  CHECK(refusal({no_rate, y}) == "input 'input' has no sample rate");
  CHECK(refusal({u, other_clock}) ==
        "inputs 'input' and 'output' have the clock domains '' and 'card'; a spectrum needs one clock");
  CHECK(refusal({facts(1, "A", {"iq"}, 149), y}) ==
        "the input has 149 samples; needed: at least 150 (1 skipped and 2 averaged periods of 50)");
  CHECK(refusal({facts(1, "A", {"iq"}, 150), y}) == "no failure");
}

TEST_CASE("averaging_dft: too few periods, values that are not finite and silent lines end the run by name") {
  CHECK(failure_of([] { run(2 * kPeriod + 49, 64, [](auto& b) { b.set("skip", std::int64_t{1}); }); }) ==
        "2 whole periods of 50 samples, 1 of them skipped; needed: at least 2 after 1 skipped");
  CHECK(failure_of([] { run(4 * kPeriod, 64, [](auto& b) { b.set("lines.list", std::vector<std::int64_t>{26}); }); }) ==
        "lines: line 26 is at or above the Nyquist frequency; at most 24 with a period of 50");
  BlockDriver<AveragingDftBlock> block;
  block.set("period", std::int64_t{kPeriod});
  block.configure();
  block.resolve({facts(1, "A", {"iq"}), facts(2, "rad", {"motor", "load"}), {}});
  block.activate(120, Rate(1000, 1));
  auto data = signals(120);
  data[1][1][77] = std::numeric_limits<double>::quiet_NaN();
  CHECK(failure_of([&] { block.process(data, 120); }) == "output 'load': sample 77 is not a number");
  block.reset();
  data[1][1][77] = 0.0;
  data[0][0][3] = -std::numeric_limits<double>::infinity();
  CHECK(failure_of([&] { block.process(data, 120); }) == "input 'iq': sample 3 is infinite");
  block.reset();
  data[0][0].assign(120, 1.0);
  block.process(data, 120);
  CHECK(failure_of([&] { block.finish(); }) ==
        "no line of the input stands out from its noise: is the input excited with this period?");
}

TEST_CASE("averaging_dft: lines that contradict each other are refused") {
  using Block = BlockDriver<AveragingDftBlock>;
  CHECK(refusal_of_lines([](Block& b) { b.set("lines.first", std::int64_t{9}).set("lines.last", std::int64_t{3}); }) ==
        "lines: first 9 is above last 3");
  CHECK(refusal_of_lines([](Block& b) { b.set("lines.last", std::int64_t{25}); }) ==
        "lines: last 25 is at or above the Nyquist frequency; at most 24 with a period of 50");
  CHECK(refusal_of_lines([](Block& b) {
          b.set("lines.list", std::vector<std::int64_t>{3, 3});
        }) == "lines: list does not rise: 3 after 3");
  CHECK(refusal_of_lines([](Block& b) { b.set("lines.list", std::vector<std::int64_t>{}); }) ==
        "lines: list is empty; name one line or more, or leave it out: the excited lines then");
  CHECK(refusal_of_lines([](Block& b) {
          b.set("lines.list", std::vector<std::int64_t>{3}).set("lines.first", std::int64_t{1});
        }) == "lines: give either list, or first, last and step");
}

TEST_CASE("averaging_dft: units of ratios") {
  CHECK(spectrum::ratio_unit("rad", "A") == "rad/A");
  CHECK(spectrum::ratio_unit("rad/s", "Nm") == "rad/s/Nm");
  CHECK(spectrum::ratio_unit("rad", "m/s") == "rad/(m/s)");
  CHECK(spectrum::ratio_unit("rad", "") == "rad");
  CHECK(spectrum::ratio_unit("", "V") == "1/V");
  CHECK(spectrum::ratio_unit("V", "V") == "1");
}
