#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "bases/drive_axis.hpp"
#include "bases/second_order.hpp"
#include "catch.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/cubic_stiffness.hpp"
#include "effects/input_offset.hpp"
#include "effects/offset.hpp"
#include "plugins/residual/declared_base.hpp"
#include "plugins/residual/sampled/records.hpp"
#include "sampled/sampled_measurement.hpp"
#include "trace/joint_fit.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::testing;
namespace fs = std::filesystem;

namespace {

/// A column of a file of the shared data; empty, with the reason printed, where it is absent.
Eigen::VectorXd column(const std::string& name, int which) {
  const char* given = std::getenv("BODEFLOW_DATA");
  const fs::path path =
      (given != nullptr ? fs::path(given) : fs::path(BODEFLOW_SOURCE_DIR).parent_path() / "shared" / "data") / name;
  std::ifstream in(path);
  if (!in) {
    std::cout << "skipped: " << path.string() << " is absent (set BODEFLOW_DATA)\n";
    return {};
  }
  std::string line, cell;
  std::getline(in, line);
  std::vector<double> x;
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    for (int c = 0; c <= which; ++c) std::getline(cells, cell, ',');
    x.push_back(std::stod(cell));
  }
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

Fit extended(const Fit& f, const Measurements& records, Addition a, double start) {
  JointModel model = f.model;
  model.additions.push_back(std::move(a));
  Eigen::VectorXd values(f.values().size() + 1);
  values << f.values(), start;
  return value_of(fit(model, records, {values}));
}

double error_of(const Fit& f, const Measurement& record) { return record.error(record.residual(f.model, f.values())).error; }

}  // namespace

TEST_CASE("silverbox: a hardening spring and an offset of the input bring the test errors to 0.35, 0.45 and 0.35 mV", "[long]") {
  const Eigen::VectorXd u = column("silverbox/SNLS80mV.csv", 0), y = column("silverbox/SNLS80mV.csv", 1);
  if (u.size() == 0) return;
  const auto base = declared_base<SecondOrder>({{"effort_unit", std::string("V")}, {"displacement_unit", std::string("V")}});
  const auto part = [&](Eigen::Index first, Eigen::Index next) {
    return value_of(sampled_measurement(
        recording(u.segment(first, next - first), y.segment(first, next - first), 610.3515625, "V", "V"), "part", {}, *base));
  };
  const Measurements train = {part(40650, 105712)}, tests = {part(105712, 127400), part(100, 40575), part(100, 32100)};
  // 50 samples at the start are not scored, as in the published tables.
  CHECK(tests[0]->rows() == 127400 - 105712 - 50);
  const auto starts = base->starts(train[0]->response());
  const Fit linear = value_of(fit({base, {}}, train, {Eigen::Map<const Eigen::VectorXd>(starts[0].data(), 3)}));
  CHECK(1e3 * error_of(linear, *tests[0]) == Approx(8.63).margin(0.02));
  CHECK(1e3 * error_of(linear, *tests[1]) == Approx(15.3).margin(0.3));
  Situation s;
  const Fit cubic = extended(linear, train, addition<CubicStiffness>(*base, s), 0.0);
  CHECK(1e3 * error_of(cubic, *tests[0]) == Approx(5.15).margin(0.02));
  s.input_peak = s.input_rms = 0.1;
  const Fit offset = extended(cubic, train, addition<InputOffset>(*base, s), 0.0);
  CHECK(1e3 * offset.values()[4] == Approx(-5.35).margin(0.05));
  CHECK(1e3 * error_of(offset, *tests[0]) < 0.36);
  CHECK(1e3 * error_of(offset, *tests[1]) < 0.46);
  CHECK(1e3 * error_of(offset, *tests[2]) < 0.36);
}

TEST_CASE("emps: the force residual falls from 9.7 to 2 N with dry friction and an offset of the published sizes") {
  const Eigen::VectorXd position = column("emps/emps_train.csv", 2), voltage = column("emps/emps_train.csv", 3);
  const Eigen::VectorXd test_position = column("emps/emps_test_pulses.csv", 2),
                        test_voltage = column("emps/emps_test_pulses.csv", 3);
  if (position.size() == 0 || test_position.size() == 0) return;
  const double force_constant = 35.15065;
  const auto base = declared_base<DriveAxis>({{"inverse", true}, {"filter", 20.0}, {"delay", 5e-4}});
  const auto record = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& v) {
    return value_of(sampled_measurement(recording(x, force_constant * v, 1000.0, "m", "N"), "record", {}, *base));
  };
  const Measurements train = {record(position, voltage)};
  const auto test = record(test_position, test_voltage);
  const Fit linear = value_of(fit({base, {}}, train, {Eigen::Vector2d(90.0, 300.0)}));
  CHECK(error_of(linear, *train[0]) == Approx(9.53).margin(0.1));
  Situation s;
  s.place.effort = 100.0;
  const Fit friction = extended(linear, train, addition<CoulombFriction>(*base, s), 10.0);
  s.output_peak = s.output_rms = s.residual_rms = 10.0;
  const Fit offset = extended(friction, train, addition<Offset>(*base, s), 0.0);
  // A. Janot, M. Gautier, M. Brunot, Data set and reference models of EMPS, 2019: 95.11 kg, 203.5 N s/m, 20.39 N, -3.16 N.
  CHECK(offset.values()[0] == Approx(95.11).epsilon(0.01));
  CHECK(offset.values()[1] == Approx(203.5).epsilon(0.02));
  CHECK(offset.values()[2] == Approx(20.39).epsilon(0.02));
  CHECK(offset.values()[3] == Approx(-3.16).epsilon(0.02));
  CHECK(error_of(offset, *train[0]) < 2.1);
  CHECK(error_of(offset, *test) < 3.2);
  const Gain gain = test->gain(test->residual(linear.model, linear.values()), test->residual(friction.model, friction.values()));
  CHECK(gain.likelihood > 100.0);
  CHECK(gain.block_z > 4.0);
}
