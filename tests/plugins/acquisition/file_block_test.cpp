#include "acquisition/file_block.hpp"

#include "catch.hpp"
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
