#include "catch.hpp"
#include "random_graph.hpp"

namespace bodeflow::test {
namespace {

void check_graphs(std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t seed = first; seed < last; ++seed) {
    RandomGraph made(seed);
    const Result reference = made.bench.run();
    INFO("seed " << seed << ": " << reference.outcome.reason);
    REQUIRE(reference.outcome.status == execute::Outcome::Status::complete);
    for (const Cut& cut :
         {Cut{1, 1, 0, 0}, Cut{16, 2, 0, 0}, Cut{64, 4, 1, 0}, Cut{100, 3, 2, 7}, Cut{1000, 1, 3, 11}, Cut{40, 4, 0, 1}}) {
      const Result result = made.bench.run(cut);
      INFO("chunk " << cut.chunk << ", threads " << cut.threads << ": " << result.outcome.reason);
      REQUIRE(result.outcome.status == execute::Outcome::Status::complete);
      CHECK(result.same_data(reference));
      for (const graph::Block& block : made.bench.phase.blocks) CHECK(result.said(block.name) == reference.said(block.name));
    }
  }
}

TEST_CASE("random graphs: the same bits for every cut") { check_graphs(0, 40); }

TEST_CASE("random graphs: the same bits for every cut of many", "[long]") { check_graphs(40, 2000); }

}  // namespace
}  // namespace bodeflow::test
