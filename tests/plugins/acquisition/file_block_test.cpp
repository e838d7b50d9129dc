#include "acquisition/file_block.hpp"

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "hdf5_writer.hpp"
#include "plugins/block_driver.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using acquisition::FileBlock;
using test::BlockDriver;
using test::failure_of;
using test::TemporaryFile;

namespace {

std::string table(int rows) {
  std::string text = "t [s],iq_A,theta_motor_rad,theta_load_rad,note\n";
  for (int n = 0; n < rows; ++n) {
    text +=
        std::to_string(0.0004 * n) + "," + std::to_string(n % 5) + "," + std::to_string(n) + "," + std::to_string(-n) + ",x\n";
  }
  return text;
}

}  // namespace

TEST_CASE("file block: input and output ports carry the columns that they name, in that order") {
  const TemporaryFile file(".csv", table(100));
  BlockDriver<FileBlock> block;
  block.set("file", file.path()).set("input", std::vector<std::string>{"iq"});
  block.set("output", std::vector<std::string>{"theta_load_rad", "theta_motor_rad"});
  block.configure();
  const auto facts = block.resolve({});
  REQUIRE(facts.size() == 3);
  CHECK(facts[0].channel_names == std::vector<std::string>{"iq", "theta_load", "theta_motor"});
  CHECK(facts[0].unit == "");
  CHECK(facts[1].unit == "A");
  CHECK(facts[1].rate == Rate(2500, 1));
  CHECK(facts[1].length == 100);
  CHECK(facts[2].channels == 2);
  CHECK(facts[2].unit == "rad");
  CHECK(facts[2].channel_names == std::vector<std::string>{"theta_load", "theta_motor"});
  REQUIRE(block.log().size() == 1);
  CHECK(
      block.log()[0] ==
      file.path() +
          ": 100 rows at 2500 Hz (0.04 s), equally sampled by column 't [s]', no gaps; read iq [A] 0 to 4, theta_load [rad] -99 "
          "to 0, theta_motor [rad] 0 to 99; not read note");

  block.activate(64, Rate(2500, 1));
  std::vector<double> load, motor;
  for (int call = 0; call < 2; ++call) {
    const auto out = block.process({}, 64);
    const auto made = static_cast<std::ptrdiff_t>(block.done());
    load.insert(load.end(), out[2][0].begin(), out[2][0].begin() + made);
    motor.insert(motor.end(), out[2][1].begin(), out[2][1].begin() + made);
  }
  CHECK(block.done() == 36);
  REQUIRE(load.size() == 100);
  for (int n = 0; n < 100; ++n) {
    CHECK(load[static_cast<std::size_t>(n)] == -n);
    CHECK(motor[static_cast<std::size_t>(n)] == n);
  }
  block.reset();
  CHECK(block.process({}, 3)[2][1] == std::vector<double>{0, 1, 2});
}

TEST_CASE("file block: without named columns, out carries all but time") {
  const TemporaryFile file(".tsv", "t [ms]\tu [V]\ty [V]\n0\t1\t2\n0,1\t3\t4\n");
  BlockDriver<FileBlock> block;
  block.set("file", file.path());
  block.configure();
  const auto facts = block.resolve({});
  CHECK(facts[0].channel_names == std::vector<std::string>{"u", "y"});
  CHECK(facts[0].unit == "V");
  CHECK(facts[1].channel_names == facts[0].channel_names);
  CHECK(facts[0].rate == Rate(10000, 1));
  block.activate(2, Rate(10000, 1));
  CHECK(block.process({}, 2)[0] == test::Channels{{1, 3}, {2, 4}});
}

TEST_CASE("file block: what cannot be read is refused by name") {
  const TemporaryFile file(".csv", table(10)), other(".xls", "");
  const auto refusal = [](const std::string& path, auto&& prepare) {
    BlockDriver<FileBlock> block;
    block.set("file", path);
    prepare(block);
    return failure_of([&] { block.configure(); });
  };
  const auto names = [](const char* parameter, std::vector<std::string> list) {
    return [=](BlockDriver<FileBlock>& b) { b.set(parameter, list); };
  };
  CHECK(refusal("/nowhere/x.csv", [](auto&) {}) == "/nowhere/x.csv: can't be opened: No such file or directory");
  CHECK(refusal(other.path(), [](auto&) {}) ==
        other.path() + ": ending '.xls'; read are .csv, .txt, .tsv, .dat, .h5, .hdf5, .mat, .wav, .flac, .uff, .unv");
  CHECK(refusal(file.path(), names("input", {"iq_B"})) ==
        file.path() +
            ": input: no column 'iq_B'; the file has t [s], iq_A, theta_motor_rad, theta_load_rad, note (did you mean 'iq_A'?)");
  CHECK(refusal(file.path(), names("output", {"iq", "iq_A"})) == "output: column 'iq_A' stands twice");
  CHECK(refusal(file.path(), names("columns", {"note"})) == file.path() + ":2:16: column 'note': 'x' is not a number");
  CHECK(refusal(file.path(), [](BlockDriver<FileBlock>& b) { b.set("time", "ignore"); }) ==
        "time: ignore needs rate: the samples per second");
}

TEST_CASE("file block: a file that changes between check and run ends the run") {
  TemporaryFile file(".csv", table(100));
  BlockDriver<FileBlock> block;
  block.set("file", file.path()).set("columns", std::vector<std::string>{"iq"});
  block.configure();
  block.resolve({});
  file.write(table(50));
  block.activate(64, Rate(2500, 1));
  CHECK(failure_of([&] { block.process({}, 64); }) == file.path() + ": changed while it was read");
}

TEST_CASE("file block: a part of an HDF5 file is read, and what was found is told") {
  const TemporaryFile file(".h5");
  std::vector<double> sine, flat(1000, 3.0);
  for (int n = 0; n < 1000; ++n) sine.push_back(std::min(std::sin(0.1 * n), 0.5));
  test::Hdf5Writer(file.path())
      .put("drive/u", sine)
      .put("drive/brake", flat)
      .put("drive/gain", {2.0}, {})
      .attribute("drive/u", "unit", "V")
      .attribute("drive", "rate", 500.0);
  BlockDriver<FileBlock> block;
  block.set("file", file.path()).set("start", std::int64_t{100}).set("count", std::int64_t{500});
  block.configure();
  const auto facts = block.resolve({});
  CHECK(facts[0].length == 500);
  CHECK(facts[0].rate == Rate(500, 1));
  CHECK(facts[0].channel_names == std::vector<std::string>{"drive/brake", "drive/u"});
  REQUIRE(block.log().size() == 3);
  CHECK(block.log()[0] == file.path() +
                              ": 500 rows (101 to 600 of 1000) at 500 Hz (1 s), rate as the file states it, gaps can't be seen "
                              "without a time column; read drive/brake 3 to 3, drive/u [V] -0.99999 to 0.5; not read drive/gain "
                              "(is a single number, no column)");
  CHECK(block.log()[1] == "warning: " + file.path() + ": column 'drive/brake' is constant at 3: was it connected?");
  CHECK(block.log()[2] ==
        "warning: " + file.path() + ": column 'drive/u' rests 8 times at 0.5 for three samples or more: clipped?");
  block.activate(64, Rate(500, 1));
  std::vector<double> read;
  while (read.size() < 500) {
    const auto out = block.process({}, 64);
    read.insert(read.end(), out[0][1].begin(), out[0][1].begin() + static_cast<std::ptrdiff_t>(block.done()));
    if (block.done() < 64) break;
  }
  CHECK(read == std::vector<double>(sine.begin() + 100, sine.begin() + 600));
}

TEST_CASE("file block: parts, time units and data sets that make no sense are refused") {
  const TemporaryFile file(".h5");
  test::Hdf5Writer(file.path()).put("u", std::vector<double>(10, 1.0)).put("clock", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  const auto refusal = [&](auto&& prepare) {
    BlockDriver<FileBlock> block;
    block.set("file", file.path());
    prepare(block);
    return failure_of([&] { block.configure(); });
  };
  using Driver = BlockDriver<FileBlock>;
  CHECK(refusal([](Driver& b) { b.set("start", std::int64_t{3}).set("to", 1.0); }) ==
        "start and count go by rows, from and to by time: give one pair");
  CHECK(refusal([](Driver& b) { b.set("from", 2.0).set("to", 1.0); }) == "from is not before to");
  CHECK(refusal([](Driver& b) { b.set("time_unit", std::string("V")); }) == "time_unit: 'V' is no unit of time");
  CHECK(refusal([](Driver& b) { b.set("time_column", std::string("clok")); }) ==
        file.path() + ": time_column: no column 'clok'; the file has clock, u (did you mean 'clock'?)");
  CHECK(refusal([](Driver& b) { b.set("columns", std::vector<std::string>{"v"}); }) ==
        file.path() + ": columns: no column 'v'; the file has clock, u");
  BlockDriver<FileBlock> block;
  block.set("file", file.path()).set("time_column", std::string("clock")).set("time_unit", std::string("ms")).set("to", 0.005);
  block.configure();
  const auto facts = block.resolve({});
  CHECK(facts[0].channel_names == std::vector<std::string>{"u"});
  CHECK(facts[0].rate == Rate(1000, 1));
  CHECK(facts[0].length == 5);
}

TEST_CASE("file block: a column that holds time under another name is compared with the rate") {
  const auto warnings = [](const std::string& text, double rate, const std::string& time_check = "check") {
    const TemporaryFile file(".csv", text);
    BlockDriver<FileBlock> block;
    block.set("file", file.path()).set("rate", rate).set("time", time_check).set("columns", std::vector<std::string>{"u"});
    block.configure();
    std::vector<std::string> found;
    const std::string begin = "warning: " + file.path() + ":";
    for (const std::string& line : block.log()) {
      if (line.rfind(begin, 0) == 0) found.push_back(line.substr(begin.size()));
    }
    return found;
  };
  const auto rows = [](const std::string& header, int count, int lost, double step) {
    std::string text = header + "\n";
    for (int n = 0; n < count; ++n) {
      char line[64];
      std::snprintf(line, sizeof line, "%.1f;%d\n", step * (n + (n >= lost ? 1 : 0)), n % 3);
      text += line;
    }
    return text;
  };
  using Lines = std::vector<std::string>;
  const std::string regular = rows("Zeit [ms];u [V]", 5000, 5000, 0.4);
  CHECK(warnings(regular, 2400.0) == Lines{" column 'Zeit [ms]' steps by 0.4 ms (2500 Hz), but rate is 2400 Hz: name it with "
                                           "time_column, or correct rate"});
  CHECK(warnings(regular, 2500.0).empty());
  CHECK(warnings(regular, 2400.0, "ignore").empty());
  const Lines gap = warnings(rows("Zeit [ms];u [V]", 5000, 4990, 0.4), 2500.0);
  REQUIRE(gap.size() == 1);
  CHECK(gap[0].rfind(" column 'Zeit [ms]' rises as time does, but not in equal steps (", 0) == 0);
  CHECK(
      gap[0].find(".csv:4992: gap of 1 sample after 1.9956 s: a step of 0.0008 s where samples are 0.0004 s apart): if it holds "
                  "time, name it with time_column") != std::string::npos);
  CHECK(warnings("delay [ms],u\n3,1\n2,1\n4,2\n5,2\n6,0\n7,1\n", 10.0).size() == 0);
  CHECK(warnings("when_s,u\nnow,1\n2,1\n4,2\n5,2\n6,0\n7,1\n", 10.0).size() == 0);
}

TEST_CASE("file block: a rate that the file states is compared with a column of time in the same data") {
  const TemporaryFile file(".h5");
  std::vector<double> clock(100), u(100);
  for (std::size_t n = 0; n < clock.size(); ++n) {
    clock[n] = 2.0 * static_cast<double>(n);
    u[n] = static_cast<double>(n % 7);
  }
  test::Hdf5Writer(file.path())
      .put("u", u)
      .put("stamp", clock)
      .put("short", {1, 2, 3, 4, 5, 6})
      .attribute("stamp", "unit", "ms")
      .attribute("short", "unit", "ms")
      .attribute("u", "rate", 400.0);
  BlockDriver<FileBlock> block;
  block.set("file", file.path()).set("columns", std::vector<std::string>{"u"});
  block.configure();
  REQUIRE(block.log().size() == 2);
  CHECK(block.log()[1] == "warning: " + file.path() +
                              ": column 'stamp' steps by 2 ms (500 Hz), but the file states 400 Hz: if it "
                              "holds time, name it with time_column");
}
