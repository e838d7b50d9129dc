#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>

#include "block_driver.hpp"
#include "catch.hpp"
#include "plants/ladder.hpp"
#include "validation/truncation_block.hpp"
#include "windings.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using validation::Truncation;

namespace {

records::ModelData winding_model() {
  records::ModelData m;
  m.method = "hand";
  m.form = "state_space";
  m.state_space = *plants::ladder_system(winding(3, 1));
  m.order = m.state_space->states();
  return m;
}

}  // namespace

TEST_CASE("truncation: fewer states within the bound of the Hankel singular values, errors over the data") {
  BlockDriver<Truncation> block;
  block.set("states", std::int64_t{5});
  block.configure();
  block.resolve({});
  block.activate(1, Rate(1, 1));
  const auto f = frequencies(80);
  const auto exact = measured(winding(3, 1), f, 1, 0.0, 0.0);
  block.receive(records::write_model(winding_model()), 0.0, 0);
  block.receive(records::write_response(exact), 0.0, 1);
  block.finish();
  REQUIRE(block.records().size() == 1);
  const RecordView r(*block.records()[0]);
  const auto m = records::read_linear_model(r);
  REQUIRE(m);
  CHECK(m->state_space->states() == 5);
  CHECK(r.array("hankel_singular_values")->size == 7);
  double squares = 0.0, largest = 0.0;
  const auto g = numerics::frequency_response(*m->state_space, f);
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    const double error = std::abs(g[static_cast<std::size_t>(k)](0, 0) - exact.response(k, 0));
    squares += error * error;
    largest = std::max(largest, error);
  }
  CHECK(*r.number("rms_error") == Approx(std::sqrt(squares / 80.0)).epsilon(1e-6));
  CHECK(*r.number("max_error") == Approx(largest).epsilon(1e-6));
  CHECK(largest <= *r.number("error_bound") * (1.0 + 1e-9));
  CHECK(largest > 0.0);
}

TEST_CASE("truncation: more states than the model has, and an unstable model, are refused") {
  const auto failing = [](records::ModelData m, std::int64_t states) {
    return failure_of([&] {
      BlockDriver<Truncation> block;
      block.set("states", states);
      block.configure();
      block.resolve({});
      block.activate(1, Rate(1, 1));
      block.receive(records::write_model(m), 0.0, 0);
      block.finish();
    });
  };
  CHECK_FALSE(failing(winding_model(), 9).empty());
  auto unstable = winding_model();
  unstable.state_space->A *= -1.0;
  CHECK_FALSE(failing(unstable, 2).empty());
}
