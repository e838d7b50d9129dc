// D. A. Jue's composite of bands: the automatic procedure, its log, and the acceptance figure A4.

#include "sanathanan_koerner/multi_band.hpp"

#include <bodeflow/numerics/frequency_response.hpp>
#include <numbers>

#include "../block_driver.hpp"
#include "../spectrum/record_bytes.hpp"
#include "catch.hpp"
#include "records/model.hpp"
#include "records/response.hpp"
#include "sanathanan_koerner/measured.hpp"
#include "sanathanan_koerner/multi_band_block.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;

namespace {

/// Two groups of modes a decade apart with a flat valley between them.
Data two_groups() {
  Data d = test::data_of(test::geometric(0.5, 200.0, 240), Eigen::MatrixXcd::Zero(240, 1));
  for (const double wn : {2.0, 3.1, 4.2, 60.0, 75.0, 90.0}) {
    for (Eigen::Index k = 0; k < 240; ++k) {
      const double w = d.omega_rad_s[k];
      d.response(k, 0) += wn * wn / std::complex<double>(wn * wn - w * w, 0.06 * wn * w);
    }
  }
  return d;
}

}  // namespace

TEST_CASE("multi-band: weights are tiered about the band") {
  const Eigen::VectorXd w = tiered_weights(Eigen::Vector4d(1.0, 2.0, 3.0, 4.0), {2.0, 3.0, 0.1, 1e-4});
  CHECK(w == Eigen::Vector4d(0.1, 1.0, 1.0, 1e-4));
}

TEST_CASE("multi-band: the cut lies in the flat valley between two groups of modes") {
  const Data data = two_groups();
  const auto line = flattest_line(data, 0, data.lines() - 1);
  REQUIRE(line);
  CHECK(data.omega_rad_s[*line] > 4.2);
  CHECK(data.omega_rad_s[*line] < 60.0);
  CHECK_FALSE(flattest_line(data, 0, 15));
}

TEST_CASE("multi-band: given cuts and orders the sum nears the data and its state space is that sum") {
  const Data data = two_groups();
  MultiBandSettings s;
  s.cuts_rad_s = {15.0};
  s.orders = {6, 6};
  const auto found = multi_band_fit(data, s);
  REQUIRE(found);
  REQUIRE(found->bands.size() == 2);
  CHECK(found->error < 0.05);
  CHECK(found->one_band_order <= 12);
  CHECK_FALSE(found->log.empty());
  CHECK(found->log.back().iterations.size() == 2);
  const auto system = state_space(*found);
  REQUIRE(system);
  CHECK(system->states() == 12);
  const auto at = numerics::frequency_response(*system, data.omega_rad_s / (2.0 * std::numbers::pi));
  for (Eigen::Index k = 0; k < data.lines(); k += 20)
    CHECK(std::abs(at[static_cast<std::size_t>(k)](0, 0) - found->response(k, 0)) < 1e-9);
}

TEST_CASE("multi-band: the procedure finds cuts and orders itself and keeps one band where that is better") {
  const Data data = two_groups();
  MultiBandSettings s;
  s.highest_order = 12;
  const auto found = multi_band_fit(data, s);
  REQUIRE(found);
  CHECK(found->error <= found->one_band_error);
  CHECK(found->one_band_error < 1e-10);  // 12 poles are the whole system
  CHECK(found->bands.size() == 1);
  s.highest_order = 6;
  const auto coarse = multi_band_fit(data, s);
  REQUIRE(coarse);
  CHECK(coarse->bands.size() > 1);
  CHECK(coarse->error < coarse->one_band_error);
}

TEST_CASE("multi-band: plans that do not fit are refused") {
  const Data data = two_groups();
  const auto reason = [&](auto change) {
    MultiBandSettings s;
    s.cuts_rad_s = {15.0};
    change(s);
    const auto found = multi_band_fit(data, s);
    return found ? std::string("a model") : found.error().text;
  };
  CHECK(reason([](auto& s) { s.orders = {3}; }) == "1 orders for 2 bands");
  CHECK(reason([](auto& s) { s.prewarps_rad_s = {3, 4, 5}; }) == "3 pre-warp frequencies for 2 bands");
  CHECK(reason([](auto& s) { s.cuts_rad_s = {15.0, 15.0}; }) == "the cuts between the bands must rise");
  CHECK(reason([](auto& s) {
          s.cuts_rad_s.clear();
          s.orders = {3, 3};
        }) == "orders are given band by band: give the cuts too");
}

TEST_CASE("example 2: three bands of 21 and 68 and 29 poles stay below .02 in 8 rounds", "[long]") {
  MultiBandSettings s;
  s.cuts_rad_s = {28.64, 234.43};
  s.orders = {21, 68, 29};
  s.prewarps_rad_s = {10.0, 87.0, 245.0};
  s.rounds = 8;
  const auto found = multi_band_fit(test::example_2(), s);
  REQUIRE(found);
  CHECK(found->error <= 0.02);
  CHECK(found->one_band_error <= 1.3e-3);
}

TEST_CASE("sanathanan_koerner.multi_band: model and log and residual stand in the records") {
  const Data data = two_groups();
  records::ResponseData r;
  r.form = "known_input";
  r.input_names = {"u"};
  r.output_names = {"y"};
  r.response_units = {"1"};
  r.frequency_hz = data.omega_rad_s / (2.0 * std::numbers::pi);
  r.response = data.response;
  test::BlockDriver<MultiBandBlock> block;
  block.set("cuts", std::vector<double>{15.0 / (2.0 * std::numbers::pi)}).set("orders", std::vector<std::int64_t>{6, 6});
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(records::write_response(r), 0.0);
  block.finish();
  REQUIRE(block.records().size() == 3);
  const RecordView model(*block.records()[0]), log(*block.records()[1]);
  const auto read = records::read_linear_model(model);
  REQUIRE(read);
  CHECK(read->order == 12);
  CHECK(read->state_space->states() == 12);
  CHECK(log.type() == "band_log");
  CHECK(log.array("iterations")->shape[1] == 2);
  const RecordView residual(*block.records()[2]);
  const auto bands = residual.array("band_response")->as<std::complex<double>>(),
             sum = residual.array("model_response")->as<std::complex<double>>();
  const std::size_t lines = sum.size();
  REQUIRE(bands.size() == 2 * lines);
  for (std::size_t k = 0; k < lines; ++k)
    CHECK(std::abs(bands[k] + bands[lines + k] - sum[k]) <= 1e-12 * std::abs(sum[k]) + 1e-15);
  CHECK(residual.array("band_edges")->shape.size() == 2);
  CHECK(model.number("relative_error").value() < 0.05);
  const bool poorer = model.number("relative_error").value() > model.number("one_band_error").value();
  CHECK(test::warnings_of(model).empty() != poorer);
}
