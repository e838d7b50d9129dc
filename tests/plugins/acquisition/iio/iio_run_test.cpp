// The IIO block in whole runs, against the emulated daemon of iiod_emulator.cpp.
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "acquisition/iio/quantity.hpp"
#include "acquisition/iio/session.hpp"
#include "acquisition/open_table.hpp"
#include "catch.hpp"
#include "iiod_emulator.hpp"
#include "system/command.hpp"

using bodeflow::acquisition::IioSession;
using bodeflow::acquisition::IioSpec;
using bodeflow::test::Ended;
using bodeflow::test::Folder;
using bodeflow::test::IiodEmulator;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string kGraph = BODEFLOW_SOURCE_DIR "/graphs/acquisition/iio_capture.yaml";

Ended capture(const Folder& folder, const IiodEmulator& iiod, const std::string& duration,
              std::vector<std::string> settings = {}) {
  fs::remove_all(folder.path() / "out");
  settings.insert(settings.begin(), {"uri=" + iiod.uri(), "device=counter"});
  std::vector<std::string> words{"run", kGraph, "--for", duration, "--out", "out"};
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return run_bodeflow(words, folder.path());
}

/// A session with the emulated converter.
IioSpec counter(const IiodEmulator& iiod) {
  IioSpec spec;
  spec.uri = iiod.uri();
  spec.device = "counter";
  spec.channels = {"voltage0"};
  spec.rate_hz = 100e3;
  spec.buffer = 500;
  return spec;
}

/// Indices of the emulated converter that the recording holds, by the bits in its two voltages.
std::vector<std::int64_t> recorded_indices(const Folder& folder) {
  auto reader = bodeflow::acquisition::open_table((folder.path() / "out/data.h5").string());
  REQUIRE(reader);
  std::vector<std::size_t> columns;
  for (const char* name : {"voltage0", "voltage1"}) {
    const auto column = bodeflow::acquisition::find_column((*reader)->columns(), name);
    REQUIRE(column);
    columns.push_back(*column);
  }
  REQUIRE((*reader)->start(columns, 0));
  std::vector<double> low(65536), high(65536);
  std::vector<std::int64_t> indices;
  while (true) {
    const auto rows = (*reader)->read(std::vector<double*>{low.data(), high.data()}, low.size());
    REQUIRE(rows);
    if (*rows == 0) return indices;
    for (std::size_t n = 0; n < *rows; ++n) {
      const auto bits = static_cast<std::uint16_t>(std::llround(low[n] / 0.5e-3));
      indices.push_back((std::llround(high[n] / 2e-3) + 2048) << 16 | bits);
    }
  }
}

/// Places at which an index is not the one after that before it.
std::vector<std::size_t> jumps(const std::vector<std::int64_t>& indices) {
  std::vector<std::size_t> places;
  for (std::size_t n = 1; n < indices.size(); ++n)
    if (indices[n] != indices[n - 1] + 1) places.push_back(n);
  return places;
}

void capture_whole(double seconds) {
  const Folder folder;
  const IiodEmulator iiod;
  const Ended ended = capture(folder, iiod, std::to_string(seconds) + " s");
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto indices = recorded_indices(folder);
  CHECK(indices.size() == static_cast<std::size_t>(std::llround(seconds * 1e5)));
  CHECK(indices.front() == 0);
  CHECK(jumps(indices).empty());
  CHECK(iiod.dropped() == 0);
  CHECK(iiod.attribute("device/sampling_frequency") == "100000");
  const auto device = json::parse(folder.read("out/result.json"))["results"]["adc"]["attributes"];
  CHECK(device["samples"].get<double>() == Approx(seconds * 1e5));
  CHECK(device["losses"] == 0);
  CHECK(device["measured_rate"].get<double>() == Approx(1e5).epsilon(0.02));
}

}  // namespace

TEST_CASE("two channels at 100 kHz come without a loss over the network back end for 1.5 s") { capture_whole(1.5); }

TEST_CASE("two channels at 100 kHz come without a loss over the network back end for 60 s", "[long]") { capture_whole(60); }

TEST_CASE("a pulled connection ends the run by name and keeps the data") {
  const Folder folder;
  IiodEmulator::Settings settings;
  settings.pull_at = 40000;
  const IiodEmulator iiod(settings);
  const Ended ended = capture(folder, iiod, "10 s", {"blocks.adc.buffer=1000", "blocks.adc.kernel_buffers=200"});
  CHECK(ended.exit_code == 5);
  CHECK_THAT(ended.err, Contains("block 'adc': IIO device 'counter' at " + iiod.uri() + ": the connection is gone"));
  CHECK(json::parse(folder.read("out/result.json"))["status"] == "failed");
  const auto indices = recorded_indices(folder);
  CHECK(indices.size() > 40000 - 1000 - 1024);
  CHECK(indices.size() <= 40000);
  CHECK(jumps(indices).empty());
}

TEST_CASE("a converter that stops ends the run after the timeout") {
  const Folder folder;
  IiodEmulator::Settings settings;
  settings.stall_at = 5000;
  const IiodEmulator iiod(settings);
  const Ended ended = capture(folder, iiod, "10 s", {"blocks.adc.buffer=1000", "blocks.adc.timeout=300 ms"});
  CHECK_THAT(ended.err, Contains("block 'adc': IIO device 'counter' at " + iiod.uri() + ": gave nothing for 0.3 s"));
}

TEST_CASE("losses that the time stamps show are marked at their places or end the run") {
  const Folder folder;
  IiodEmulator::Settings settings;
  settings.losses = {{3000, 17}, {8000, 1}, {16384, 4000}};
  const IiodEmulator iiod(settings);
  const std::vector<std::string> stamps{"blocks.adc.timestamps=true", "blocks.adc.buffer=1024", "blocks.adc.kernel_buffers=200"};
  auto marked = stamps;
  marked.push_back("blocks.adc.on_gap=mark");
  const Ended ended = capture(folder, iiod, "0.3 s", marked);
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto results = json::parse(folder.read("out/result.json"))["results"];
  CHECK(results["adc"]["attributes"]["losses"] == 3);
  CHECK(results["adc"]["attributes"]["missing"] == 17 + 1 + 4000);
  CHECK(results["adc.gaps"]["attributes"]["missing"] == 4000);
  CHECK(jumps(recorded_indices(folder)) == std::vector<std::size_t>{3000, 8000 - 17, 16384 - 18});
  CHECK(results["adc.gaps"]["attributes"]["position"] == 16384 - 18);

  CHECK_THAT(capture(folder, iiod, "0.3 s", stamps).err,
             Contains("block 'adc': loss before sample 3000, 17 samples missing: by the device's time stamps; raise buffer or "
                      "kernel_buffers"));
}

TEST_CASE("what the kernel dropped while the network was away is counted exactly") {
  const Folder folder;
  IiodEmulator::Settings settings;
  settings.hold_at = 10000;
  settings.hold_s = 0.3;
  const IiodEmulator iiod(settings);
  const Ended ended =
      capture(folder, iiod, "0.2 s",
              {"blocks.adc.buffer=1000", "blocks.adc.kernel_buffers=10", "blocks.adc.timestamps=true", "blocks.adc.on_gap=mark"});
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto device = json::parse(folder.read("out/result.json"))["results"]["adc"]["attributes"];
  CHECK(iiod.dropped() >= 20000);  // 0.3 s, less 0.1 s in the buffers
  CHECK(device["missing"] == iiod.dropped());
}

TEST_CASE("channels come in SI units by kind and a calibration goes on from there") {
  const Folder folder;
  const IiodEmulator iiod;
  folder.write("graph.yaml",
               "bodeflow: 1\nrun: {clock: realtime, duration: 0.02 s}\nblocks:\n  adc: {block: acquisition.iio, uri: \"" +
                   iiod.uri() +
                   "\", device: counter, channels: [temp0, voltage1], rate: 10 kHz, buffer: 100}\n"
                   "  file: {block: output.csv, file: x.csv}\nconnections:\n  - adc -> file\n");
  const auto first_row = [&](const std::vector<std::string>& settings) {
    fs::remove_all(folder.path() / "out");
    std::vector<std::string> words{"run", "graph.yaml", "--out", "out"};
    for (const std::string& s : settings) words.insert(words.end(), {"--set", s});
    const Ended ended = run_bodeflow(words, folder.path());
    INFO(ended.err);
    REQUIRE(ended.exit_code == 0);
    std::istringstream rows(folder.read("out/x.csv"));
    std::string header, row;
    std::getline(rows, header);
    std::getline(rows, row);
    return header + "|" + row;
  };
  CHECK(first_row({}) == "t [s],temp0 [K],voltage1 [V]|0,298.65,-4.096");
  folder.write("cal.csv", "channel,gain,offset,unit\nvoltage1,-2,1,A\ntemp0,1,-273.15,degC\n");
  CHECK(first_row({"blocks.adc.calibration=cal.csv"}) == "t [s],temp0 [degC],voltage1 [A]|0,25.5,9.192");
}

TEST_CASE("attributes are written before scales are read and the trigger is set") {
  const IiodEmulator iiod;
  IioSpec spec = counter(iiod);
  spec.attributes = {{"", "range", "5"}, {"voltage0", "hardwaregain", "20"}};
  spec.trigger = "timer";
  auto session = IioSession::open(spec);
  REQUIRE(session);
  REQUIRE(session->start());
  const auto samples = session->refill();
  REQUIRE(samples);
  CHECK(*samples == 500);
  std::vector<double> values(3);
  session->read(0, 100, values);
  CHECK(values == std::vector<double>{25, 25.25, 25.5});  // mV
  CHECK(iiod.attribute("device/range") == "5");
  CHECK(iiod.attribute("voltage0/hardwaregain") == "20");
  CHECK(iiod.attribute("device/trigger") == "trigger0");
}

TEST_CASE("what an IIO device has not is refused with what it has") {
  const IiodEmulator iiod;
  const auto said = [&](const std::function<void(IioSpec&)>& change) {
    IioSpec spec = counter(iiod);
    change(spec);
    const auto session = IioSession::open(spec);
    return session ? std::string("no refusal") : session.error().text;
  };
  const std::string at = "IIO device 'counter' at " + iiod.uri() + ": ";
  CHECK(said([](IioSpec& s) { s.device = "ad7606"; }) == "no IIO device 'ad7606' at " + iiod.uri() + "; it has counter, timer");
  CHECK(said([](IioSpec& s) { s.channels = {"voltage7"}; }) ==
        at + "no channel 'voltage7' that can be captured; it has voltage0, voltage1, temp0, timestamp");
  CHECK(said([](IioSpec& s) { s.channels = {"vin"}; }) ==
        at + "channel 'vin' has the id voltage0; name it by that, which tells its unit");
  CHECK(said([](IioSpec& s) {
          s.attributes = {{"", "gain", "2"}};
        }) == at + "the device has no attribute 'gain'; it has sampling_frequency, range");
  CHECK_THAT(said([](IioSpec& s) {
               s.attributes = {{"", "range", "7"}};
             }),
             Contains(at + "attribute 'range' does not take '7': Invalid argument"));
  CHECK(said([](IioSpec& s) {
          s.attributes = {{"voltage9", "scale", "7"}};
        }) == at + "the device has no input channel 'voltage9'");
  CHECK(said([](IioSpec& s) { s.trigger = "clock"; }) == at + "no trigger 'clock'");
  CHECK_THAT(said([](IioSpec& s) { s.uri = "ip:127.0.0.1:1"; }), Contains("no IIO at ip:127.0.0.1:1: Connection refused"));
  CHECK_THAT(said([](IioSpec& s) { s.uri = "nonsense"; }),
             Contains("no IIO at nonsense: ") && Contains("allowed: local:, ip:HOST"));
}

TEST_CASE("a device that runs at another rate is refused and so is simulated time") {
  const Folder folder;
  IiodEmulator::Settings settings;
  settings.slow_rate = 62500;
  const IiodEmulator iiod(settings);
  CHECK_THAT(capture(folder, iiod, "0.05 s").err,
             Contains("block 'adc': IIO device 'counter' runs at 62500 Hz where 100000 Hz were asked for"));
  CHECK_THAT(capture(folder, iiod, "0.05 s", {"run.clock=simulated"}).err, Contains("block 'adc': a device goes by real time"));
}

TEST_CASE("the kind of an IIO channel is told by its id") {
  using bodeflow::acquisition::iio_quantity;
  CHECK(iio_quantity("voltage3").unit == "V");
  CHECK(iio_quantity("voltage0-voltage1").unit == "V");
  CHECK(iio_quantity("accel_x").unit == "m/s^2");
  CHECK(iio_quantity("anglvel_z").unit == "rad/s");
  CHECK(iio_quantity("pressure").factor == 1e3);
  CHECK(iio_quantity("count0").unit.empty());
  CHECK(iio_quantity("count0").factor == 1.0);
}
