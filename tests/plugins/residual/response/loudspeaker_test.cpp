#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "../declared_base.hpp"
#include "bases/impedance.hpp"
#include "catch.hpp"
#include "linear_effects.hpp"
#include "response/hold_out_bands.hpp"
#include "response/response_measurement.hpp"
#include "trace/trace.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
namespace fs = std::filesystem;

namespace {

fs::path shared_data() {
  const char* given = std::getenv("BODEFLOW_DATA");
  return given != nullptr ? fs::path(given) : fs::path(BODEFLOW_SOURCE_DIR) / ".." / "shared" / "data";
}

/// Columns f_Hz, absZ_ohm, phaseZ_deg, reZ_ohm, imZ_ohm up to 20 kHz.
records::ResponseData impedance_in(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<double> f;
  std::vector<std::complex<double>> z;
  while (std::getline(in, line)) {
    double column[5] = {};
    std::stringstream cells(line);
    std::string cell;
    for (double& x : column) {
      std::getline(cells, cell, ',');
      x = std::stod(cell);
    }
    if (column[0] > 20e3) break;
    f.push_back(column[0]);
    z.emplace_back(column[3], column[4]);
  }
  records::ResponseData r;
  r.input_names = {"current"};
  r.output_names = {"voltage"};
  r.response_units = {"ohm"};
  r.frequency_hz = Eigen::Map<const Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size()));
  r.response = Eigen::Map<const Eigen::VectorXcd>(z.data(), static_cast<Eigen::Index>(z.size()));
  return r;
}

}  // namespace

TEST_CASE("loudspeaker: the semi-inductance is named first, and the error on the mass that was not fitted falls to 4 %") {
  const fs::path folder = shared_data() / "loudspeaker_impedance";
  if (!fs::exists(folder)) {
    std::cout << "skipped: " << folder.string() << " is absent (set BODEFLOW_DATA)\n";
    return;
  }
  const auto base = declared_base<Impedance>();
  const auto made = [&base](const records::ResponseData& r, const char* name, double mass) {
    const auto m = response_measurement(r, name, {mass}, *base);
    INFO((m ? "" : m.error().text));
    REQUIRE(m);
    return *m;
  };
  const auto light = hold_out_bands(impedance_in(folder / "L16RNX_0g.csv"), 1.0 / 3.0, 3);
  const auto heavy = hold_out_bands(impedance_in(folder / "L16RNX_16p048g.csv"), 1.0 / 3.0, 3);
  REQUIRE(light);
  REQUIRE(heavy);
  TraceData data;
  data.fit = {made(light->kept, "fit 1", 0.0), made(heavy->kept, "fit 2", 16.048e-3)};
  data.select = made(heavy->held_out, "select", 16.048e-3);
  data.test = made(impedance_in(folder / "L16RNX_8p017g.csv"), "test", 8.017e-3);
  Catalogue catalogue;
  for (const testing::Linear& e : testing::linear_effects()) catalogue.push_back({e.what, e.effect});
  TraceSettings settings;
  settings.most_effects = 2;
  const auto trace = residual::trace(base, catalogue, data, settings);
  INFO((trace ? "" : trace.error().text));
  REQUIRE(trace);
  CHECK(trace->before.error == Approx(20.9).margin(0.2));  // %
  CHECK(trace->after.error < 4.0);
  REQUIRE_FALSE(trace->searched.found.empty());
  CHECK(trace->searched.found.front().addition.name() == "semi_inductance");
  if (trace->searched.found.size() > 1) CHECK(trace->searched.found[1].addition.name() == "creep");
}
