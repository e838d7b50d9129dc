#include "output/csv_block.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "acquisition/open_table.hpp"
#include "acquisition/scan.hpp"
#include "catch.hpp"
#include "folder.hpp"
#include "output/records_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using output::CsvBlock;
using test::BlockDriver;
using test::Channels;
using test::failure_of;
using test::Folder;

namespace {

StreamFacts facts(int channels, const char* unit, std::vector<std::string> names = {}) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate(2500, 1);
  f.unit = unit;
  f.channel_names = std::move(names);
  return f;
}

const StreamFacts kNothing;

}  // namespace

TEST_CASE("output.csv: what is written is read back bit for bit, with names, units and rate") {
  const Folder folder;
  std::mt19937_64 random(3);
  Channels sent(3);
  const std::size_t rows = 3000;
  for (auto& channel : sent) {
    while (channel.size() < rows) {
      const auto bits = random();
      double x;
      std::memcpy(&x, &bits, sizeof x);
      if (std::isfinite(x) && std::abs(x) >= std::numeric_limits<double>::min()) channel.push_back(x);
    }
  }
  {
    BlockDriver<CsvBlock> block;
    block.write_to(folder.path());
    block.configure();
    block.resolve({facts(1, "A", {"iq"}), facts(2, "rad", {"motor", "load"}), kNothing, kNothing});
    block.activate(rows, Rate(2500, 1));
    for (std::size_t n = 0; n < rows; n += 1000) {
      const auto part = [&](std::size_t c) {
        return std::vector<double>(sent[c].begin() + static_cast<std::ptrdiff_t>(n),
                                   sent[c].begin() + static_cast<std::ptrdiff_t>(n + 1000));
      };
      block.process({{part(0)}, {part(1), part(2)}, {}, {}}, 1000);
    }
    block.finish();
  }
  auto reader = acquisition::open_table((folder.path() / "signals.csv").string());
  REQUIRE(reader);
  const std::vector<std::size_t> selected = {1, 2, 3};
  const auto time = acquisition::find_time_column(**reader, selected, {});
  REQUIRE(time);
  const auto summary = acquisition::scan_table(**reader, selected, *time, {}, {});
  REQUIRE(summary);
  CHECK(summary->rate == Rate(2500, 1));
  CHECK((*reader)->columns()[1].name == "iq");
  CHECK((*reader)->columns()[3].unit == "rad");
  REQUIRE((*reader)->start(selected, 0));
  Channels got(3, std::vector<double>(rows));
  REQUIRE((*reader)->read(std::vector<double*>{got[0].data(), got[1].data(), got[2].data()}, rows).value() == rows);
  CHECK(got == sent);
}

TEST_CASE("output.csv: numbers have the shortest digits that mean the same, time is the nearest double") {
  const Folder folder;
  BlockDriver<CsvBlock> block;
  block.write_to(folder.path());
  block.set("columns", std::vector<std::string>{"u", "y, \"outer\""}).set("file", "a.csv");
  block.configure();
  block.resolve({facts(2, "V"), kNothing, kNothing, kNothing});
  block.activate(4, Rate(2500, 1));
  block.process({{{0.1, -0.0, 1e300, 3.0}, {1.0 / 3.0, 5e-324, -2.5, 100000.0}}, {}, {}, {}}, 4);
  block.finish();
  CHECK(folder.text("a.csv") ==
        "t [s],u [V],\"y, \"\"outer\"\" [V]\"\n"
        "0,0.1,0.3333333333333333\n"
        "0.0004,-0,5e-324\n"
        "0.0008,1e+300,-2.5\n"
        "0.0012,3,1e+05\n");
  block.reset();
  block.process({{{7.0}, {8.0}}, {}, {}, {}}, 1);
  block.finish();
  CHECK(folder.text("a.csv") == "t [s],u [V],\"y, \"\"outer\"\" [V]\"\n0,7,8\n");
}

TEST_CASE("output.csv: a complex channel takes two columns") {
  const Folder folder;
  BlockDriver<CsvBlock> block;
  block.write_to(folder.path());
  block.set("time", false);
  block.configure();
  StreamFacts f = facts(1, "V");
  f.element = BF_C64;
  block.resolve({f, kNothing, kNothing, kNothing});
  block.activate(2, Rate(2500, 1));
  block.process({{{1.0, -2.0, 0.5, 4.0}}, {}, {}, {}}, 2);
  block.finish();
  CHECK(folder.text("signals.csv") == "re(in) [V],im(in) [V]\n1,-2\n0.5,4\n");
}

TEST_CASE("output.csv: names that do not fit are refused") {
  const auto refusal = [](std::vector<std::string> columns, std::vector<StreamFacts> inputs) {
    BlockDriver<CsvBlock> block;
    block.set("columns", columns);
    block.configure();
    return failure_of([&] { block.resolve(inputs); });
  };
  CHECK(refusal({"u"}, {facts(2, "V"), kNothing, kNothing, kNothing}) == "columns names 1 columns; the inputs have 2");
  CHECK(refusal({"u", "u"}, {facts(2, "V"), kNothing, kNothing, kNothing}) ==
        "two columns named 'u'; name them apart with columns: [...]");
  CHECK(refusal({}, {facts(1, "V", {"out"}), facts(1, "V", {"out"}), kNothing, kNothing}) ==
        "two columns named 'out'; name them apart with columns: [...]");
  CHECK(refusal({"t"}, {facts(1, "V"), kNothing, kNothing, kNothing}) ==
        "two columns named 't'; name them apart with columns: [...]");
  StreamFacts no_rate = facts(1, "V");
  no_rate.rate = {};
  CHECK(refusal({}, {no_rate, kNothing, kNothing, kNothing}) ==
        "input 'in' has no sample rate, so there is no time column; give time: false");
}

TEST_CASE("output.csv: a disk that is full ends the run with its reason") {
  if (!std::filesystem::exists("/dev/full")) {
    WARN("skipped: this system has no /dev/full");
    return;
  }
  BlockDriver<CsvBlock> block;
  block.write_to("/dev");
  block.set("file", "full");
  block.configure();
  block.resolve({facts(1, "V"), kNothing, kNothing, kNothing});
  block.activate(30000, Rate(2500, 1));
  CHECK(failure_of([&] {
          block.process({{std::vector<double>(30000, 0.125)}, {}, {}, {}}, 30000);
        }) == "/dev/full: No space left on device");
  BlockDriver<CsvBlock> small;
  small.write_to("/dev");
  small.set("file", "full");
  small.configure();
  small.resolve({facts(1, "V"), kNothing, kNothing, kNothing});
  small.activate(1, Rate(2500, 1));
  small.process({{{1.0}}, {}, {}, {}}, 1);
  CHECK(failure_of([&] { small.finish(); }) == "/dev/full: No space left on device");
}

TEST_CASE("output.csv: a folder that is not there is named") {
  BlockDriver<CsvBlock> block;
  block.write_to("/nowhere");
  block.configure();
  block.resolve({facts(1, "V"), kNothing, kNothing, kNothing});
  CHECK(failure_of([&] { block.activate(1, Rate(2500, 1)); }) == "/nowhere/signals.csv: No such file or directory");
}

TEST_CASE("output.csv, output.records: a name that is no file of the run directory is refused before the run") {
  const auto refusal = [](auto block, const char* name) {
    block->set("file", std::string(name));
    return failure_of([&] { block->configure(); });
  };
  const auto csv = [&](const char* name) { return refusal(std::make_unique<BlockDriver<CsvBlock>>(), name); };
  CHECK(csv("") == "file: '': the name is empty");
  CHECK(csv("../evil.csv") == "file: '../evil.csv': '..' is not allowed: files go into the run directory");
  CHECK(csv("a/../../b.csv") == "file: 'a/../../b.csv': '..' is not allowed: files go into the run directory");
  CHECK(csv("/tmp/b.csv") == "file: '/tmp/b.csv': the path must be relative: files go into the run directory");
  CHECK(csv("a/") == "file: 'a/': names a folder, not a file");
  CHECK(csv(".") == "file: '.': names a folder, not a file");
  CHECK(refusal(std::make_unique<BlockDriver<output::RecordsBlock>>(), "../r.jsonl") ==
        "file: '../r.jsonl': '..' is not allowed: files go into the run directory");
  for (const char* name : {"b.csv", "deep/er/b.csv", "..b.csv"}) {
    BlockDriver<CsvBlock> block;
    block.set("file", std::string(name));
    block.configure();
  }
}
