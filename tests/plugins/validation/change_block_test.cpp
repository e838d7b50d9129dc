#include "validation/change_block.hpp"

#include "block_driver.hpp"
#include "catch.hpp"
#include "windings.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using validation::ChangeBlock;

namespace {

/// Ports by number: before, after, repeat.
std::string run(BlockDriver<ChangeBlock>& block, const std::vector<std::pair<std::uint32_t, records::ResponseData>>& responses) {
  return failure_of([&] {
    block.configure();
    block.resolve({});
    block.activate(1, Rate(1, 1));
    for (const auto& [port, response] : responses) block.receive(records::write_response(response), 0.0, port);
    block.finish();
  });
}

}  // namespace

TEST_CASE("change block: verdict, bands and modes stand in the record") {
  const auto f = frequencies(200);
  auto after = winding(3, 1);
  after.earth_capacitance_f[1] *= 1.2;
  BlockDriver<ChangeBlock> block;
  block.set("bands", std::vector<double>{2e3, 2e4, 1e5, 4e5});
  CHECK(run(block, {{0, measured(winding(3, 1), f, 1)}, {1, measured(after, f, 2)}}) == "no failure");
  REQUIRE(block.records().size() == 1);
  const RecordView r(*block.records()[0]);
  CHECK(r.type() == "change");
  CHECK(r.text("verdict") == "changed");
  CHECK(r.text("scatter") == "unknown");
  CHECK(r.array("band_low")->size == 3);
  CHECK(r.texts("band_verdicts")->size() == 3);
  CHECK(r.array("significance")->size == 200);
  const auto status = r.texts("mode_status");
  REQUIRE(status);
  CHECK(r.array("mode_frequency_shift")->size == status->size());
  CHECK(std::count(status->begin(), status->end(), "moved") > 0);
}

TEST_CASE("change block: what is missing or wrong is refused by name") {
  const auto f = frequencies(50);
  BlockDriver<ChangeBlock> alone;
  CHECK(run(alone, {{0, measured(winding(3, 1), f, 1)}}) == "no frequency response arrived on 'after'");
  BlockDriver<ChangeBlock> edges;
  edges.set("bands", std::vector<double>{10.0, 5.0});
  CHECK(run(edges, {}) == "bands: the edges must rise");
}
