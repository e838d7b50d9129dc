#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "catch.hpp"
#include "drive/current_sensor_block.hpp"
#include "drive/encoder_block.hpp"
#include "drive/voltage_sensor_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using test::BlockDriver;
using test::Channels;
using test::failure_of;

namespace {

constexpr double kRate = 10e3;
constexpr double kTurn = 2 * std::numbers::pi;

StreamFacts stream(const char* unit, int channels = 1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(kRate);
  f.length = 1 << 20;
  f.unit = unit;
  return f;
}

template <class B>
void start(BlockDriver<B>& block, const StreamFacts& input, std::size_t most = 1 << 16) {
  block.configure();
  block.resolve({input});
  block.activate(most, Rate::from_hz(kRate));
}

Channels zeros(std::size_t channels, std::size_t samples) { return Channels(channels, std::vector<double>(samples)); }

double mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

double covariance(const std::vector<double>& x, const std::vector<double>& y) {
  const double mx = mean(x), my = mean(y);
  double sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n) sum += (x[n] - mx) * (y[n] - my);
  return sum / static_cast<double>(x.size());
}

RecordBuilder properties() { return RecordBuilder("bench_properties"); }

}  // namespace

TEST_CASE("current sensor: without settings it measures what is there, to the bit") {
  BlockDriver<CurrentSensor> sensor;
  start(sensor, stream("A", 2));
  const Channels x{{1.25, -0.1, 3e-7}, {0.3, 1e300, -2}};
  CHECK(sensor.process({x}, 3)[0] == x);
}

TEST_CASE("current sensor: gain, offset and hum are added at the stated instants") {
  BlockDriver<CurrentSensor> sensor;
  sensor.set("gain", 1.02).set("offset", -0.05).set("hum", 0.3).set("hum_frequency", 60.0).set("hum_phase", 0.4);
  start(sensor, stream("A"));
  std::vector<double> all;
  for (int call = 0; call < 3; ++call) {
    const auto y = sensor.process({{std::vector<double>(100, 2.0)}}, 100)[0][0];
    all.insert(all.end(), y.begin(), y.end());
  }
  for (std::size_t n = 0; n < all.size(); ++n) {
    CHECK(all[n] == Approx(2.04 - 0.05 + 0.3 * std::sin(kTurn * 60 * static_cast<double>(n) / kRate + 0.4)).epsilon(1e-12));
  }
}

TEST_CASE("current sensor: its noise has the std asked for, is white, and its channels are independent") {
  constexpr std::size_t count = 1 << 16;
  BlockDriver<CurrentSensor> sensor;
  sensor.set("noise", 0.22).set("seed", std::int64_t{5});
  start(sensor, stream("A", 2), count);
  const Channels y = sensor.process({zeros(2, count)}, count)[0];
  const double root = std::sqrt(static_cast<double>(count));
  for (const auto& channel : y) {
    CHECK(std::abs(mean(channel)) < 4 * 0.22 / root);
    CHECK(covariance(channel, channel) == Approx(0.22 * 0.22).epsilon(4 * std::sqrt(2.0) / root));
    const std::vector<double> before(channel.begin(), channel.end() - 1), after(channel.begin() + 1, channel.end());
    CHECK(std::abs(covariance(before, after)) < 4 * 0.22 * 0.22 / root);
  }
  CHECK(std::abs(covariance(y[0], y[1])) < 4 * 0.22 * 0.22 / root);
}

TEST_CASE("current sensor: the seed fixes the noise, reset repeats it, another seed gives another") {
  const auto noise = [](std::int64_t seed) {
    BlockDriver<CurrentSensor> sensor;
    sensor.set("noise", 1.0).set("seed", seed);
    start(sensor, stream("A"));
    const auto first = sensor.process({zeros(1, 64)}, 64)[0];
    sensor.reset();
    CHECK(sensor.process({zeros(1, 64)}, 64)[0] == first);
    return first;
  };
  CHECK(noise(7) == noise(7));
  CHECK(noise(7) != noise(8));
}

TEST_CASE("current sensor: hidden properties replace its parameters and end with a reset") {
  BlockDriver<CurrentSensor> sensor;
  sensor.set("gain", 3.0);
  start(sensor, stream("A"));
  sensor.receive(
      properties().set("effect", "delay").set("current_delay", 200e-6).set("current_offset", 1.0).set("dead_time", 1e-6), 0);
  CHECK(sensor.process({{{1, 2, 3, 4}}}, 4)[0][0] == std::vector<double>{1, 1, 4, 7});
  sensor.reset();
  CHECK(sensor.process({{{1, 2, 3, 4}}}, 4)[0][0] == std::vector<double>{3, 6, 9, 12});
}

TEST_CASE("current sensor: hidden properties do not show in facts or advice") {
  BlockDriver<CurrentSensor> sensor;
  start(sensor, stream("A"));
  sensor.receive(properties().set("current_noise", 0.5).set("current_lag", 1e-3), 0);
  StreamFacts excited = stream("A");
  excited.notes["excitation.frequencies"] = {10, 4000};
  CHECK(sensor.advise({excited}).empty());
  CHECK(sensor.resolve({stream("A")})[0].note("noise.std").empty());
}

TEST_CASE("current sensor: lag or delay with lines above a tenth of the sampling rate is warned of") {
  BlockDriver<CurrentSensor> sensor;
  sensor.set("delay", 50e-6);
  sensor.configure();
  StreamFacts excited = stream("A");
  excited.notes["excitation.frequencies"] = {10, 1000};
  CHECK(sensor.advise({excited}).empty());
  excited.notes["excitation.frequencies"] = {10, 1001};
  CHECK(
      sensor.advise({excited}) ==
      std::vector<std::string>{"warning: lag and delay are right up to a tenth of the sampling rate, 1000 Hz, and the excitation "
                               "goes up to 1001 Hz; excite lower lines"});
}

TEST_CASE("sensors: bad hidden properties are refused by name") {
  const auto refusal = [](const RecordBuilder& record) {
    BlockDriver<CurrentSensor> sensor;
    start(sensor, stream("A"));
    return failure_of([&] { sensor.receive(record, 0); });
  };
  CHECK(refusal(properties().set("current_delay", -1e-3)) == "property current_delay = -0.001, allowed: 0 to 100");
  CHECK(refusal(properties().set("current_lag", "much")) == "property current_lag is not a number");
  CHECK(refusal(properties().set("current_noise", std::numeric_limits<double>::quiet_NaN())) ==
        "property current_noise = nan, allowed: 0 to 1e+06");
  BlockDriver<CurrentSensor> sensor;
  start(sensor, stream("A"));
  sensor.process({{{1, 2, 3}}}, 3);
  CHECK(failure_of([&] { sensor.receive(properties(), 0); }) ==
        "properties: a record before sample 3, allowed: before the first");
}

TEST_CASE("sensors: samples that are not finite and streams in other units are refused by name") {
  BlockDriver<CurrentSensor> current;
  start(current, stream("A", 2));
  current.process({zeros(2, 4)}, 4);
  CHECK(failure_of([&] {
          current.process({{{0, 0, 0}, {0, std::nan(""), 0}}}, 3);
        }) == "sample 5 of channel 2 is NaN, allowed: finite values");
  BlockDriver<VoltageSensor> voltage;
  voltage.configure();
  CHECK(failure_of([&] { voltage.resolve({stream("A")}); }) == "the input is in A, allowed: V");
  start(voltage, stream(""));
  CHECK(failure_of([&] { voltage.process({{{-INFINITY}}}, 1); }) == "sample 0 of channel 1 is infinite, allowed: finite values");
}

TEST_CASE("voltage sensor: ratio error, offset and noise, and hidden ones in their place") {
  BlockDriver<VoltageSensor> sensor;
  sensor.set("ratio_error", 0.02).set("offset", 0.5);
  start(sensor, stream("V"));
  CHECK(sensor.process({{{0, 100, -50}}}, 3)[0][0] == std::vector<double>{0.5, 102.5, -50.5});
  sensor.reset();
  sensor.receive(properties().set("voltage_ratio_error", -0.5).set("voltage_offset", 0.0), 0);
  CHECK(sensor.process({{{0, 100, -50}}}, 3)[0][0] == std::vector<double>{0, 50, -25});
}

TEST_CASE("sensors: the note of white noise is that of the input through the gain and the sensor's own") {
  StreamFacts noisy = stream("V");
  noisy.notes["noise.std"] = {0.3};
  BlockDriver<VoltageSensor> voltage;
  voltage.set("ratio_error", 1.0).set("noise", 0.8);
  voltage.configure();
  CHECK(voltage.resolve({noisy})[0].note("noise.std") == std::vector<double>{1.0});
  CHECK(voltage.resolve({stream("V")})[0].note("noise.std") == std::vector<double>{0.8});
  noisy.unit = "A";
  BlockDriver<CurrentSensor> current;
  current.set("lag", 1e-3).set("noise", 0.8);
  current.configure();
  CHECK(current.resolve({noisy})[0].note("noise.std").empty());
}

TEST_CASE("encoder: counts are whole and speed is their difference, exact on the mean") {
  BlockDriver<Encoder> encoder;
  encoder.set("resolution", std::int64_t{4096}).set("index_offset", 0.1);
  start(encoder, stream("rad"));
  constexpr std::size_t count = 5000;
  const double omega = 31.7;
  std::vector<double> angle(count);
  for (std::size_t n = 0; n < count; ++n) angle[n] = -2.0 + omega * static_cast<double>(n) / kRate;
  const auto out = encoder.process({{angle}}, count);
  double sum = 0;
  for (std::size_t n = 0; n < count; ++n) {
    REQUIRE(out[0][0][n] == std::floor((angle[n] - 0.1) * 4096 / kTurn));
    sum += out[1][0][n];
  }
  CHECK(out[1][0][0] == 0.0);
  // What is left of the rounding: one count over the whole time.
  CHECK(std::abs(sum / (count - 1) - omega) <= kTurn / 4096 * kRate / (count - 1));
  const double step = kTurn / 4096 * kRate;
  for (const double v : out[1][0]) CHECK(std::abs(v / step - std::round(v / step)) < 1e-9);
}

TEST_CASE("encoder: backwards it counts down, and an offset of a turn moves the count by its resolution") {
  BlockDriver<Encoder> encoder;
  encoder.set("resolution", std::int64_t{8});
  start(encoder, stream("rad"));
  CHECK(encoder.process({{{0.1, -0.1, -0.9}}}, 3)[0][0] == std::vector<double>{0, -1, -2});
  encoder.reset();
  encoder.receive(properties().set("encoder_index_offset", -kTurn), 0);
  CHECK(encoder.process({{{0.1, -0.1, -0.9}}}, 3)[0][0] == std::vector<double>{8, 7, 6});
}

TEST_CASE("encoder: it refuses more than one channel, other units, and angles beyond its counter") {
  BlockDriver<Encoder> encoder;
  encoder.set("resolution", std::int64_t{1000});
  encoder.configure();
  CHECK(failure_of([&] { encoder.resolve({stream("rad", 2)}); }) == "the input has 2 channels, allowed: 1");
  CHECK(failure_of([&] { encoder.resolve({stream("V")}); }) == "the input is in V, allowed: rad");
  start(encoder, stream("rad"));
  CHECK(failure_of([&] { encoder.process({{{0, 1e14}}}, 2); }) == "sample 1 is beyond 2^53 counts");
}
