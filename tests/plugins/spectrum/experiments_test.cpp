// spectrum.averaging_dft with several experiments: schedule, records, advice, and measured data.

#include <cstring>
#include <iostream>
#include <limits>

#include "catch.hpp"
#include "data.hpp"
#include "periodic.hpp"
#include "plugins/block_driver.hpp"
#include "spectrum/averaging_dft.hpp"
#include "spectrum/averaging_dft_block.hpp"
#include "spectrum/experiment_schedule.hpp"
#include "spectrum/period_kernels.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using spectrum::AveragingDftBlock;
using Driver = BlockDriver<AveragingDftBlock>;

namespace {

StreamFacts facts(int channels, const char* unit, double rate = 1000.0, std::int64_t length = -1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(rate);
  f.length = length;
  f.unit = unit;
  return f;
}

/// The block over these signals; records stay with the driver.
void feed(Driver& block, const std::vector<Channels>& all, std::size_t chunk, double rate = 1000.0) {
  std::vector<StreamFacts> inputs;
  for (const Channels& port : all) inputs.push_back(facts(static_cast<int>(port.size()), "V", rate));
  if (inputs.size() == 2) inputs.emplace_back();
  block.configure();
  block.resolve(inputs);
  block.activate(chunk, inputs[0].rate);
  const std::size_t count = all[0][0].size();
  for (std::size_t n = 0; n < count; n += chunk) {
    std::vector<Channels> part = all;
    const auto from = static_cast<std::ptrdiff_t>(n), to = static_cast<std::ptrdiff_t>(std::min(n + chunk, count));
    for (auto& port : part) {
      for (auto& c : port) c = std::vector<double>(c.begin() + from, c.begin() + to);
    }
    block.process(part, static_cast<std::uint64_t>(to - from));
  }
  block.finish();
}

RecordView record(const Driver& block, const char* type) {
  for (const bf_record* r : block.records()) {
    if (RecordView(r->bytes).type() == type) return RecordView(r->bytes);
  }
  throw Failure(std::string("no record ") + type);
}

template <class T>
std::vector<T> values(const RecordView& r, const char* name) {
  const auto a = r.array(name);
  REQUIRE(a);
  const auto v = a->as<T>();
  return {v.begin(), v.end()};
}

constexpr int kSamples = 64;

/// Two inputs, two outputs y = [u1 - u2, 2 u2], M realisations of 2 experiments with 1 transient and 3 steady periods each; `gap`
/// samples of something else before each.
std::vector<Channels> orthogonal(int realisations, int gap) {
  numerics::Random random(3);
  std::vector<Channels> s{Channels(2), Channels(2)};
  for (int m = 0; m < realisations; ++m) {
    const Eigen::VectorXd a = random_multisine(kSamples, lines_of(2, 24), 0.2, random),
                          b = random_multisine(kSamples, lines_of(2, 24), 0.2, random);
    for (int e = 0; e < 2; ++e) {
      for (int n = -gap; n < 4 * kSamples; ++n) {
        const double u1 = n < 0 ? 9.0 : a[n % kSamples], u2 = n < 0 ? -9.0 : (e == 0 ? 1.0 : -1.0) * b[n % kSamples];
        const double settling = n < kSamples ? 5.0 : 0.0;
        s[0][0].push_back(u1);
        s[0][1].push_back(u2);
        s[1][0].push_back(u1 - u2 + settling + (n < 0 ? 0.0 : 0.01 * random.normal()));
        s[1][1].push_back(2.0 * u2 + settling + (n < 0 ? 0.0 : 0.01 * random.normal()));
      }
    }
  }
  return s;
}

void prepare(Driver& block, int realisations) {
  block.set("period", std::int64_t{kSamples}).set("skip", std::int64_t{1}).set("periods", std::int64_t{3});
  block.set("realisations", std::int64_t{realisations}).set("lines.first", std::int64_t{2}).set("lines.last", std::int64_t{24});
}

}  // namespace

TEST_CASE("experiments: two inputs from consecutive experiments, one realisation and several") {
  for (const int realisations : {1, 4}) {
    Driver block;
    prepare(block, realisations);
    feed(block, orthogonal(realisations, 0), 100);
    const RecordView r = record(block, "frequency_response");
    CHECK(r.integer("realisations") == realisations);
    CHECK(r.integer("periods") == 3);
    CHECK(r.integer("dropped_samples") == realisations * 2 * kSamples);
    CHECK(r.texts("input_names") == std::vector<std::string_view>{"input_1", "input_2"});
    CHECK(r.texts("response_units") == std::vector<std::string_view>{"1", "1", "1", "1"});
    CHECK(r.number("confidence") == 0.95);
    CHECK(r.number("degrees_of_freedom") == Approx(realisations == 1 ? 4.0 : 3.0));
    const auto G = values<Complex>(r, "response");
    const auto radius = values<double>(r, "confidence_radius");
    REQUIRE(G.size() == 23 * 4);
    const double truth[4] = {1.0, -1.0, 0.0, 2.0};
    int inside = 0;
    for (std::size_t i = 0; i < G.size(); ++i) {
      CHECK(std::abs(G[i] - truth[i % 4]) < 0.02);
      inside += std::abs(G[i] - truth[i % 4]) < radius[i] ? 1 : 0;
    }
    CHECK(inside > 78);  // 87.4 expected, standard deviation 2.1
    CHECK(r.array("nonlinear_variance").has_value() == (realisations > 1));
    CHECK(r.array("noise_level").has_value());
    CHECK_FALSE(r.array("input_mean").has_value());
  }
}

TEST_CASE("experiments: recorded ones are found by their starts, equal to consecutive ones bit for bit") {
  Driver consecutive, found;
  prepare(consecutive, 3);
  prepare(found, 3);
  feed(consecutive, orthogonal(3, 0), 64);
  std::vector<std::int64_t> starts;
  const int gap = 23;
  for (int i = 0; i < 6; ++i) starts.push_back(gap + i * (gap + 4 * kSamples));
  found.set("starts", starts);
  feed(found, orthogonal(3, gap), 50);
  const auto expected = values<Complex>(record(consecutive, "frequency_response"), "response");
  CHECK(values<Complex>(record(found, "frequency_response"), "response") == expected);
  CHECK(record(found, "frequency_response").integer("dropped_samples") == 6 * (gap + kSamples));
}

TEST_CASE("experiments: records are equal bit for bit whatever the size of the calls") {
  using Bytes = std::vector<std::vector<std::uint8_t>>;
  const auto bytes = [](std::size_t chunk, auto also) {
    Driver block;
    prepare(block, 2);
    also(block);
    feed(block, orthogonal(2, 0), chunk);
    Bytes all;
    for (const bf_record* r : block.records()) all.emplace_back(r->bytes, r->bytes + r->size);
    return all;
  };
  const auto check = [&](auto also) {
    const Bytes expected = bytes(1, also);
    CHECK(expected.size() == 2);
    for (const std::size_t chunk : {7u, 64u, 256u, 1000u}) CHECK(bytes(chunk, also) == expected);
  };
  check([](Driver&) {});
  check([](Driver& b) { b.set("detrend", "linear"); });
  check([](Driver& b) { b.set("transient", "remove"); });
}

TEST_CASE("experiments: a schedule that contradicts itself or the data is refused by name") {
  const auto refusal = [](auto change, std::int64_t length = -1) {
    Driver block;
    prepare(block, 2);
    change(block);
    return failure_of([&] {
      block.configure();
      block.resolve({facts(2, "V", 1000.0, length), facts(2, "V", 1000.0, length), {}});
    });
  };
  CHECK(refusal([](Driver&) {}) == "no failure");
  CHECK(refusal([](Driver& b) {
          b.set("starts", std::vector<std::int64_t>{0, 100});
        }) == "starts has 2 entries; needed: one for each of 4 experiments (realisations 2 x experiments 2)");
  CHECK(refusal([](Driver& b) {
          b.set("starts", std::vector<std::int64_t>{0, 256, 500, 900});
        }) == "starts: 500 is inside the experiment that starts at 256 and is 256 samples long");
  CHECK(refusal([](Driver& b) { b.set("experiments", std::int64_t{1}); }) ==
        "experiments is 1; needed: at least one for each of the 2 inputs");
  CHECK(refusal([](Driver& b) { b.set("every", std::int64_t{2}); }) ==
        "every: only where one experiment is averaged to the end of the stream");
  CHECK(refusal([](Driver& b) { b.set("form", "reference"); }) == "form: reference needs the input 'reference' connected");
  CHECK(refusal([](Driver& b) { b.set("outliers", 0.5); }) ==
        "outliers: periods up to the usual distance can't be left out; allowed: above 1, or 0");
  CHECK(refusal([](Driver& b) { b.set("realisations", std::int64_t{1}).set("periods", std::int64_t{1}); }) ==
        "periods is 1; the variance needs at least 2 periods, or several realisations");
  CHECK(refusal([](Driver&) {}, 1023) ==
        "the input has 1023 samples; needed: at least 1024 (1 skipped and 3 averaged periods of 64 in each of 4 experiments)");
  CHECK(refusal([](Driver& b) { b.set("transient", "remove").set("outliers", 3.0); }) ==
        "outliers and transient: remove: one of the two; the transient is told from an unbroken record");
  Driver block;
  prepare(block, 5);
  CHECK(failure_of([&] { feed(block, orthogonal(2, 0), 100); }) ==
        "the data ended in experiment 1 of realisation 3 after 0 of 3 averaged periods; needed: 2560 samples, found 1024");
}

TEST_CASE("experiments: a reference of other size or clock is refused") {
  const auto refusal = [](const char* form, const StreamFacts& reference) {
    Driver block;
    block.set("period", std::int64_t{kSamples}).set("form", form);
    block.configure();
    return failure_of([&] { block.resolve({facts(1, "V"), facts(1, "V"), reference}); });
  };
  StreamFacts other = facts(1, "V");
  other.clock = "card";
  CHECK(refusal("reference", facts(1, "V")) == "no failure");
  CHECK(refusal("reference", facts(2, "V")) == "input 'reference' has 2 channels; needed: as many as 'input', 1");
  CHECK(refusal("reference", other) ==
        "inputs 'input' and 'reference' have the clock domains '' and 'card'; a spectrum needs one clock");
  CHECK(refusal("known_input", facts(1, "V")) == "no failure");
}

TEST_CASE("experiments: levels tell excited, odd and even lines, and warnings go to the log and the records") {
  numerics::Random random(1);
  const Eigen::VectorXd u = random_multisine(kSamples, {3, 7, 11}, 1.0, random);
  std::vector<Channels> s{Channels(1), Channels(1)};
  for (int n = 0; n < 3 * kSamples; ++n) {
    s[0][0].push_back(u[n % kSamples]);
    s[1][0].push_back(u[n % kSamples] + 0.05 * u[n % kSamples] * u[n % kSamples] + 1e-3 * random.normal());
  }
  Driver block;
  block.set("period", std::int64_t{kSamples});
  feed(block, s, 64);
  const RecordView r = record(block, "spectral_levels");
  CHECK(values<std::int64_t>(r, "line") == lines_of(3, 11));
  CHECK(values<std::int64_t>(r, "kind") == std::vector<std::int64_t>{0, 2, 1, 2, 0, 2, 1, 2, 0});
  CHECK(values<double>(r, "output_level").size() == 9);
  CHECK(values<double>(r, "frequency").front() == Approx(3000.0 / 64));
  const auto warnings = *r.texts("warnings");
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].substr(0, 15) == "only 3 periods:");
  CHECK(warnings[1].substr(0, 55) == "output 'output': distortion at unexcited lines is even ");
  REQUIRE(block.log().size() == 2);
  CHECK(block.log()[0] == "warning: " + std::string(warnings[0]));
  const RecordView response = record(block, "frequency_response");
  CHECK(values<double>(response, "odd_distortion").size() == 3);
  CHECK(values<double>(response, "even_distortion")[0] > 10.0 * values<double>(response, "odd_distortion")[0]);
}

TEST_CASE("experiments: a loop is measured from its reference, which also tells what is excited") {
  // u = r - 0.5 y, y = 2 u + v: G = 2, U = R / 2 - V / 4.
  numerics::Random random(1);
  const Eigen::VectorXd r = random_multisine(kSamples, {3, 6, 9}, 1.0, random);
  std::vector<Channels> s{Channels(1), Channels(1), Channels(1)};
  for (int n = 0; n < 8 * kSamples; ++n) {
    const double v = 0.01 * random.normal();
    s[0][0].push_back(0.5 * r[n % kSamples] - 0.25 * v);
    s[1][0].push_back(r[n % kSamples] + 0.5 * v);
    s[2][0].push_back(r[n % kSamples]);
  }
  for (const char* form : {"reference", "errors_in_variables"}) {
    Driver block;
    block.set("period", std::int64_t{kSamples}).set("form", form);
    feed(block, s, 100);
    const RecordView found = record(block, "frequency_response");
    CHECK(found.text("form") == form);
    CHECK(found.texts("input_names") == std::vector<std::string_view>{"input"});
    CHECK(values<std::int64_t>(found, "line") == std::vector<std::int64_t>{3, 6, 9});
    const auto G = values<Complex>(found, "response");
    const auto variance = values<double>(found, "variance");
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::norm(G[k] - 2.0) < 20.0 * variance[k]);
    // dG = (dY - 2 dU) / U = V / U.
    CHECK(variance[0] + variance[1] + variance[2] == Approx(3.0 * 1e-4 / (8 * kSamples) / 0.0625).epsilon(0.8));
  }
}

TEST_CASE("experiments: lines that the excitation states are no distortion, however small") {
  numerics::Random random(1);
  const Eigen::VectorXd u = random_multisine(kSamples, {3, 9}, 1.0, random) + random_multisine(kSamples, {5}, 0.02, random);
  std::vector<Channels> s{Channels(1), Channels(1)};
  for (int n = 0; n < 6 * kSamples; ++n) {
    s[0][0].push_back(u[n % kSamples]);
    s[1][0].push_back(u[n % kSamples] + 1e-3 * random.normal());
  }
  const auto kinds = [&](bool stated) {
    Driver block;
    block.set("period", std::int64_t{kSamples});
    StreamFacts input = facts(1, "V");
    if (stated) input.notes["excitation.frequencies"] = {3000.0 / kSamples, 5000.0 / kSamples, 9000.0 / kSamples};
    block.configure();
    block.resolve({input, facts(1, "V"), {}});
    block.activate(s[0][0].size(), input.rate);
    block.process({s[0], s[1]}, s[0][0].size());
    block.finish();
    return values<std::int64_t>(record(block, "spectral_levels"), "kind");
  };
  CHECK(kinds(false) == std::vector<std::int64_t>{0, 2, 1, 2, 1, 2, 0});
  CHECK(kinds(true) == std::vector<std::int64_t>{0, 2, 0, 2, 1, 2, 0});
}

TEST_CASE("experiments: outliers are counted and named in a warning") {
  numerics::Random random(1);
  const Eigen::VectorXd u = random_multisine(kSamples, lines_of(1, 20), 1.0, random);
  std::vector<Channels> s{Channels(1), Channels(1)};
  for (int n = 0; n < 8 * kSamples; ++n) {
    s[0][0].push_back(u[n % kSamples]);
    s[1][0].push_back(u[n % kSamples] + 1e-2 * random.normal() + (n == 300 ? 20.0 : 0.0));
  }
  Driver block;
  block.set("period", std::int64_t{kSamples}).set("outliers", 3.0);
  feed(block, s, 64);
  CHECK(record(block, "frequency_response").integer("periods") == 7);
  CHECK(block.log() ==
        std::vector<std::string>{"warning: 1 period is left out as outliers (averaged period 5): look for what disturbed them"});
}

TEST_CASE("experiments: advice before a run") {
  StreamFacts u = facts(1, "V", 1000.0, 1050), y = facts(1, "A", 1000.0, 1050);
  u.notes["excitation.period"] = {0.1};
  u.notes["excitation.frequencies"] = {10.0, 30.0, 50.0};
  u.notes["excitation.amplitudes"] = {2.0, 2.0, 2.0};
  u.notes["excitation.crest_factor"] = {1.7};
  y.notes["noise.std"] = {0.5};
  y.notes["plant.modes"] = {40.0, 200.0};
  y.notes["plant.settling_time"] = {0.25};
  const auto advice = [&](std::int64_t period, std::int64_t skip) {
    Driver block;
    block.set("period", period).set("skip", skip);
    block.configure();
    return block.advise({u, y, {}});
  };
  CHECK(advice(100, 3) == std::vector<std::string>{
                              "100 samples a period, lines 10 Hz apart; 7 averaged periods, 3 skipped: 1 s",
                              "the last 50 samples (0.5 periods) are not used",
                              "excited: 3 lines from 10 to 50 Hz, up to 0.1 of the Nyquist frequency (500 Hz)",
                              "the plant's mode at 200 Hz lies outside the excited band", "crest factor of the excitation: 1.7",
                              "expected std of |G|: 0.01336 A/V from the white noise of the output, at lines of "
                              "median amplitude 2; 4 times the "
                              "periods would halve it, in 3.1 s"});
  const auto wrong = advice(150, 0);
  REQUIRE(wrong.size() == 7);
  CHECK(wrong[1] ==
        "warning: the excitation repeats after 100 samples, and the period is 150: the spectra will leak; set period to 100 or a "
        "multiple of "
        "it");
  CHECK(wrong[4] == "warning: the plant settles in 0.25 s, and 0 s are skipped: set skip to 2, or transient: remove");
  Driver repeated;
  repeated.set("period", std::int64_t{100}).set("skip", std::int64_t{1}).set("periods", std::int64_t{2});
  repeated.set("realisations", std::int64_t{2});
  repeated.configure();
  CHECK(repeated.advise({u, y, {}})[3] ==
        "warning: the excitation is the same in all realisations, so that nonlinear distortion repeats and is not in the "
        "variance: give each phases of its own (phases: random, experiment_periods and realisations of the generator)");
  u.notes["excitation.experiment"] = {0.5};
  CHECK(advice(100, 3)[2] ==
        "warning: the phases of the excitation change after each 500 samples, and an experiment is taken to be 1000 (skip and "
        "periods): set periods to 2, experiments and realisations as the excitation has them");
  u.notes["excitation.experiment"] = {1.0};
  CHECK(advice(100, 3).size() == 6);
  y.notes["plant.settling_time"] = {std::numeric_limits<double>::infinity()};
  CHECK(advice(100, 0)[4].rfind("the plant has a pole that does not decay: ", 0) == 0);
}

TEST_CASE("experiments: the loops of every vector unit give the same bits") {
#if defined(__x86_64__)
  const int highest = __builtin_cpu_supports("avx512f") ? 4 : __builtin_cpu_supports("avx2") ? 3 : 1;
  const auto sums = [](int level) {
    spectrum::AveragingDft average(101, spectrum::Layout{1, 2, 0}, spectrum::AveragingDft::Detrend::none, level);
    numerics::Random random(1);
    for (int p = 0; p < 5; ++p) average.add(noise(303, 1.0, random).reshaped(101, 3));
    return *average.moments();
  };
  const auto one = sums(1), other = sums(highest);
  CHECK(one.mean == other.mean);
  CHECK(one.variance == other.variance);
  CHECK(one.covariance == other.covariance);
  for (const int level : {1, highest}) {
    std::vector<double> x(37, 1.0), to(37);
    CHECK(spectrum::copy_finite(x.data(), to.data(), x.size(), level));
    CHECK(to == x);
    for (const std::size_t n : {std::size_t{0}, std::size_t{17}, std::size_t{36}}) {
      for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        auto spoilt = x;
        spoilt[n] = bad;
        CHECK_FALSE(spectrum::copy_finite(spoilt.data(), to.data(), x.size(), level));
      }
    }
  }
#endif
}

TEST_CASE("experiments: Silverbox, ten realisations of a multisine found by their starts") {
  const auto data = shared_table("silverbox/SNLS80mV.csv", {"u_V", "y_V"});
  if (!data) return;
  Driver block;
  block.set("period", std::int64_t{8192}).set("periods", std::int64_t{1}).set("realisations", std::int64_t{10});
  block.set("starts", std::vector<std::int64_t>{40986, 49678, 58370, 67062, 75754, 84446, 93138, 101830, 110522, 119214});
  feed(block, {{data->columns[0]}, {data->columns[1]}}, 4096, 610.3515625);
  const RecordView r = record(block, "frequency_response");
  const auto G = values<Complex>(r, "response");
  const auto variance = values<double>(r, "variance"), f = values<double>(r, "frequency");
  std::size_t peak = 0;
  double relative = 0.0;
  for (std::size_t k = 0; k < G.size(); ++k) {
    if (std::abs(G[k]) > std::abs(G[peak])) peak = k;
    relative += std::sqrt(variance[k]) / std::abs(G[k]) / double(G.size());
  }
  std::cout << "Silverbox: " << G.size() << " lines from " << f.front() << " to " << f.back() << " Hz, |G| "
            << std::abs(G.front()) << " at the lowest, peak " << std::abs(G[peak]) << " at " << f[peak]
            << " Hz, mean relative deviation of the mean " << relative << "\n";
  for (const std::string& warning : block.log()) std::cout << "  " << warning << "\n";
  CHECK(r.integer("realisations") == 10);
  for (const std::int64_t k : values<std::int64_t>(r, "line")) CHECK(k % 2 == 1);
  CHECK(f[peak] == Approx(69.0).margin(3.0));
}

TEST_CASE("experiments: the fine steering mirror, 3 x 3 from three experiments of 2 periods") {
  const auto response = [](const char* file) {
    std::vector<Complex> G;
    const auto data = shared_table(file, {"u1_V", "u2_V", "u3_V", "y1_um", "y2_um", "y3_um"});
    if (!data) return G;
    Driver block;
    block.set("period", std::int64_t{8192}).set("periods", std::int64_t{2});  // the excited lines, 1 to 3839
    const auto& c = data->columns;
    feed(block, {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}}, 4096, 6400.0);
    const RecordView r = record(block, "frequency_response");
    CHECK(r.integer("periods") == 2);
    G = values<Complex>(r, "response");
    std::cout << file << ":\n";
    for (const std::string& warning : block.log()) std::cout << "  " << warning << "\n";
    return G;
  };
  const auto low = response("fine_steering_mirror/fsm_100mV_train.csv"),
             train = response("fine_steering_mirror/fsm_300mV_train.csv"),
             test = response("fine_steering_mirror/fsm_300mV_test.csv");
  if (low.empty() || train.empty() || test.empty()) return;
  const auto difference = [](const std::vector<Complex>& a, const std::vector<Complex>& b) {
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) above += std::norm(a[i] - b[i]), below += std::norm(b[i]);
    return std::sqrt(above / below);
  };
  std::cout << "fine steering mirror: relative difference 300 mV test to train " << difference(test, train) << ", 100 to 300 mV "
            << difference(low, train) << "\n";
  CHECK(difference(test, train) == Approx(0.048).margin(0.003));
  CHECK(difference(low, train) == Approx(0.33).margin(0.02));
}
