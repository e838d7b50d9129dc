#include <random>
#include <thread>

#include "catch.hpp"
#include "plugins/sha256.hpp"
#include "record/data_file.hpp"
#include "recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;
using nlohmann::ordered_json;

namespace {

execute::Outcome complete() {
  execute::Outcome outcome;
  outcome.time_s = 1.5;
  outcome.metrics.resize(1);
  outcome.metrics[0].dropped = 3;
  return outcome;
}

/// Records `samples` of both streams in pieces of the sizes that `piece` gives, and `records` records; the hashes.
template <class Piece>
ordered_json hashes_of(std::uint64_t samples, int records, Piece piece) {
  const TemporaryFolder folder;
  const auto phase = source_phase();
  const auto run = make_run(folder.path(), source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  for (std::uint64_t n = 0; n < samples;) {
    const std::uint64_t count = std::min<std::uint64_t>(piece(), samples - n);
    REQUIRE(give_real(sink, n, count));
    REQUIRE(give_complex(sink, n, count));
    n += count;
  }
  for (int k = 0; k < records; ++k) REQUIRE(sink.record({0, 0}, numbered_record(k), 0.25 * k));
  REQUIRE(run->end_phase(complete()));
  return read_json(run->path() / "manifest.json")["hashes"];
}

}  // namespace

TEST_CASE("recorded streams read back bit for bit, with the facts that belong to them") {
  const TemporaryFolder folder;
  const auto phase = source_phase();
  const auto run = make_run(folder.path(), source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  constexpr std::uint64_t kSamples = 300'000;  // 4.8 MB: more than a queue holds
  REQUIRE(give_real(sink, 0, kSamples));
  REQUIRE(give_complex(sink, 0, 10));
  REQUIRE(run->end_phase(complete()));

  const auto file = record::DataFile::open(run->path() / "data.h5");
  REQUIRE(file);
  REQUIRE((*file)->streams().size() == 2);
  const auto* real = (*file)->stream("source.real");
  REQUIRE(real != nullptr);
  CHECK(real->path == "streams/source.real");
  CHECK(real->element == BF_F64);
  CHECK(real->channels == 2);
  CHECK(real->length == kSamples);
  CHECK(real->rate == Rate(1000, 1));
  CHECK(real->clock == "bench");
  CHECK(real->channel_names == std::vector<std::string>{"voltage", "current"});
  CHECK(real->channel_units == std::vector<std::string>{"V", "A"});
  CHECK(real->first_position == 0);
  const auto values = (*file)->read(*real, 0, kSamples);
  REQUIRE(values);
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < kSamples; ++n)
    for (int c = 0; c < 2; ++c)
      if ((*values)[2 * n + static_cast<std::uint64_t>(c)] != real_value(n, c)) ++wrong;
  CHECK(wrong == 0);
  CHECK((*file)->read(*real, 299'999, 1).value() == std::vector<double>{real_value(299'999, 0), real_value(299'999, 1)});

  const auto* complex = (*file)->stream("source.complex");
  REQUIRE(complex != nullptr);
  CHECK(complex->element == BF_C64);
  CHECK(complex->rate == Rate(1000, 3));
  CHECK(complex->channel_units == std::vector<std::string>{"rad/A"});
  CHECK((*file)->read(*complex, 8, 2).value() == std::vector<double>{8.0, -4.0, 9.0, -4.5});
  CHECK((*file)->read(*complex, 8, 3).error() ==
        "can't read '" + (run->path() / "data.h5").string() + "': samples 8 to 11 of 'source.complex' are asked for, it has 10");
}

TEST_CASE("hashes of streams and records don't depend on how the samples were cut") {
  std::mt19937_64 random(1);
  const auto whole = hashes_of(20'000, 5, [] { return 20'000U; });
  CHECK(hashes_of(20'000, 5, [] { return 7U; }) == whole);
  CHECK(hashes_of(20'000, 5, [&] { return 1 + random() % 3000; }) == whole);
  CHECK(hashes_of(19'999, 5, [] { return 1024U; })["source.real"] != whole["source.real"]);
  CHECK(hashes_of(20'000, 6, [] { return 1024U; })["source.model"] != whole["source.model"]);
  CHECK(hashes_of(20'000, 6, [] { return 1024U; })["source.real"] == whole["source.real"]);
}

TEST_CASE("a stream's hash is SHA-256 of its interleaved samples, a record's of time, size and bytes") {
  const auto hashes = hashes_of(3, 1, [] { return 2U; });
  Sha256 samples;
  for (std::uint64_t n = 0; n < 3; ++n)
    for (int c = 0; c < 2; ++c) {
      const double x = real_value(n, c);
      samples.update(&x, sizeof x);
    }
  CHECK(hashes["source.real"] == samples.hex());
  Sha256 records;
  const double time = 0.0;
  const auto record = numbered_record(0);
  const std::uint64_t size = record.size();
  records.update(&time, sizeof time);
  records.update(&size, sizeof size);
  records.update(record.bytes(), record.size());
  CHECK(hashes["source.model"] == records.hex());
  CHECK(hashes["source.trace"] == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");  // of nothing
  std::vector<std::string> order;
  for (const auto& [key, hash] : hashes.items()) order.push_back(key);
  CHECK(order == std::vector<std::string>{"source.real", "source.complex", "source.model", "source.trace"});
}

TEST_CASE("records of every message output read back with their times, the last ones stand in result.json in graph order") {
  const TemporaryFolder folder;
  const auto phase = source_phase();
  const auto run = make_run(folder.path(), source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  REQUIRE(sink.record({0, 1}, numbered_record(100), 0.5));
  for (int k = 0; k < 1500; ++k) REQUIRE(sink.record({0, 0}, numbered_record(k), 0.001 * k));
  REQUIRE(run->end_phase(complete()));
  CHECK(number_of(run->last_record("", "source", "model")) == 1499);
  CHECK(number_of(run->last_record("", "source", "trace")) == 100);
  CHECK_FALSE(run->last_record("", "source", "absent"));
  REQUIRE(run->close("complete", ""));

  const auto file = record::DataFile::open(run->path() / "data.h5");
  REQUIRE(file);
  const auto* model = (*file)->records_of("source.model");
  REQUIRE(model != nullptr);
  CHECK(model->count == 1500);
  const auto records = (*file)->read(*model, 0, 1500);
  REQUIRE(records);
  for (int k = 0; k < 1500; k += 100) {
    CHECK(number_of((*records)[static_cast<std::size_t>(k)].record) == k);
    CHECK((*records)[static_cast<std::size_t>(k)].time_s == 0.001 * k);
  }

  const auto result = read_json(run->path() / "result.json");
  CHECK(result["bodeflow"] == 1);
  CHECK(result["graph"] == "source");
  CHECK(result["status"] == "complete");
  REQUIRE(result["results"].size() == 2);
  CHECK(result["results"].begin().key() == "source");
  CHECK(result["results"]["source"]["attributes"]["number"] == 1499);
  CHECK(result["results"]["source.trace"]["arrays"]["parameters"]["data"] == ordered_json({100.0, 100.25, 100.5}));
}

TEST_CASE("a run with phases keeps each phase and repetition apart, results under the phase's name") {
  const TemporaryFolder folder;
  const auto measure = source_phase("measure"), identify = source_phase("identify");
  const auto run = make_run(folder.path(), source_graph({measure, identify}));
  const auto one = [&](const graph::Phase& phase, int repeat, int number) {
    execute::Sink& sink = **run->begin_phase(phase, source_facts(), {{"chunk", 1024}}, repeat);
    REQUIRE(give_real(sink, 0, static_cast<std::uint64_t>(number)));
    REQUIRE(sink.record({0, 0}, numbered_record(number), 0.0));
    REQUIRE(run->end_phase(complete()));
  };
  one(measure, 0, 1);
  one(measure, 1, 2);
  one(identify, 0, 3);
  REQUIRE(run->close("complete", ""));

  const auto file = record::DataFile::open(run->path() / "data.h5");
  REQUIRE(file);
  for (const auto& [key, length] :
       {std::pair{"measure.source.real", 1U}, {"measure@2.source.real", 2U}, {"identify.source.real", 3U}}) {
    REQUIRE((*file)->stream(key) != nullptr);
    CHECK((*file)->stream(key)->length == length);
  }
  CHECK((*file)->stream("measure@2.source.real")->path == "streams/measure@2/source.real");
  CHECK((*file)->stream("measure@2.source.real")->origin.repeat == 1);

  const auto manifest = read_json(run->path() / "manifest.json");
  CHECK(manifest["phases"].size() == 3);
  CHECK(manifest["phases"][1]["repeat"] == 1);
  CHECK(manifest["phases"][2]["blocks"]["source"]["dropped"] == 3);
  CHECK(manifest["hashes"].contains("measure@2.source.model"));
  const auto results = read_json(run->path() / "result.json")["results"];
  REQUIRE(results.size() == 2);
  CHECK(results["measure.source"]["attributes"]["number"] == 2);
  CHECK(results["identify.source"]["attributes"]["number"] == 3);
  CHECK(read_json(run->path() / "plan.json")["phases"].size() == 2);  // the repetition has the plan of the first
}

TEST_CASE("a record that is set stands in the results, and a sink whose phase ended refuses") {
  const TemporaryFolder folder;
  const auto phase = source_phase("sweep");
  const auto run = make_run(folder.path(), source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  REQUIRE(run->end_phase(complete()));
  CHECK(give_real(sink, 0, 10).error() == "the recording of this phase has ended");
  CHECK(sink.record({0, 0}, numbered_record(1), 0.0).error() == "the recording of this phase has ended");
  run->set_result("sweep", "source", "trace", numbered_record(42));
  CHECK(number_of(run->last_record("sweep", "source", "trace")) == 42);
  CHECK(run->result()["results"]["sweep.source.trace"]["attributes"]["number"] == 42);
}

TEST_CASE("a file that is being written can be read, and streams come from several threads at once") {
  const TemporaryFolder folder;
  const auto phase = source_phase();
  const auto run = make_run(folder.path(), source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  constexpr std::uint64_t kSamples = 1'000'000;
  std::thread other([&] {
    for (std::uint64_t n = 0; n < kSamples; n += 1000) (void)give_complex(sink, n, 1000);
  });
  for (std::uint64_t n = 0; n < kSamples; n += 1000) REQUIRE(give_real(sink, n, 1000));
  const auto live = record::DataFile::open(run->path() / "data.h5");  // 16 MB went through queues of 4 MB: some of it is there
  INFO((live ? std::string() : live.error()));
  REQUIRE(live);
  const std::uint64_t seen = (*live)->stream("source.real")->length;
  CHECK(seen <= kSamples);
  const auto values = (*live)->read(*(*live)->stream("source.real"), 0, seen);
  REQUIRE(values);
  for (std::uint64_t n = 0; n < seen; n += 997) CHECK((*values)[2 * n + 1] == real_value(n, 1));
  other.join();
  REQUIRE(run->end_phase(complete()));
  const auto file = record::DataFile::open(run->path() / "data.h5");
  REQUIRE(file);
  CHECK((*file)->stream("source.real")->length == kSamples);
  CHECK((*file)->stream("source.complex")->length == kSamples);
  CHECK((*file)->read(*(*file)->stream("source.complex"), kSamples - 1, 1).value() == std::vector<double>{999'999.0, -499'999.5});
}

TEST_CASE("a file that is no recording is refused with its path") {
  const TemporaryFolder folder;
  const auto absent = record::DataFile::open(folder.path() / "data.h5");
  REQUIRE_FALSE(absent);
  CHECK(absent.error().find("can't read '" + (folder.path() / "data.h5").string() + "': can't open it: ") == 0);
}
