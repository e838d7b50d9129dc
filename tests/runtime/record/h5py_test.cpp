#include "catch.hpp"
#include "python.hpp"
#include "recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;

TEST_CASE("h5py reads streams, complex values, attributes, raw and decoded records") {
  if (!h5py_present()) {
    WARN("skipped: no Python with h5py was found (apt install python3-h5py)");
    return;
  }
  const TemporaryFolder folder;
  const auto phase = source_phase();
  const auto run = make_run(folder.path(), source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  REQUIRE(give_real(sink, 0, 100'000));
  REQUIRE(give_complex(sink, 0, 10));
  for (int k = 0; k < 1200; ++k) REQUIRE(sink.record({0, 0}, numbered_record(k), 0.001 * k));
  RecordBuilder r("every_kind");
  r.set("accepted", true).set("names", std::vector<std::string>{"R1", "µ"}).set("orders", std::vector<std::int64_t>{1, 2});
  r.set("empty", std::vector<double>{});
  auto z = r.array<std::complex<double>>("response", "rad/A", {2, 1, 1});
  z[1] = {2.0, -1.0};
  (void)r.array<std::uint8_t>("mask", "", {4});
  (void)r.array<std::int64_t>("index", "", {4});
  (void)r.array<double>("none", "", {0, 4});
  r.array<double>("scalar", "", {})[0] = 2.5;
  REQUIRE(sink.record({0, 1}, finished(r), 0.0));
  REQUIRE(run->end_phase({}));
  REQUIRE(run->close("complete", ""));
  CHECK(check_data(run->path() / "data.h5", "100000 1200") == "ok\n");
}
