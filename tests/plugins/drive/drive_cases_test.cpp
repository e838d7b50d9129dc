#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "catch.hpp"
#include "drive/motor.hpp"
#include "plugins/reference_file.hpp"

using namespace bodeflow::drive;
using Complex = std::complex<double>;

namespace {

constexpr double kStaircase = 200e-6, kPeriod = 100e-6, kLink = 540.0, kDeadTime = 1.5e-6;
constexpr std::size_t kLines = 24;

/// The paper's two bands: odd lines of 8.192 s and of 0.512 s.
struct Band {
  std::size_t steps;  // of the staircase in a period
  int first_line;
  int settling;  // periods until a transient of the slowest mode, 6.46 1/s, is below 1e-13
};
constexpr Band kLow{40960, 1, 1}, kHigh{2560, 3, 10};

enum class Supply { mean, switching };

struct Case {
  double amplitudes[2];
  Supply supply = Supply::mean;
  double dead_time_s = 0.0;
  double saturation_current = 0.0;
};

double line_omega(const Band& band, std::size_t k) {
  return 2.0 * M_PI * (band.first_line + 2.0 * static_cast<double>(k)) / (static_cast<double>(band.steps) * kStaircase);
}

/// Cosines with Schroeder's phases.
std::vector<double> command(const Band& band, double amplitude) {
  std::vector<double> u(band.steps, 0.0);
  for (std::size_t k = 0; k < kLines; ++k) {
    const double step = line_omega(band, k) * kStaircase, i = static_cast<double>(k + 1), phase = M_PI * i * (i - 1) / kLines;
    for (std::size_t m = 0; m < band.steps; ++m) u[m] += amplitude * std::cos(step * static_cast<double>(m) - phase);
  }
  return u;
}

struct Measured {
  std::vector<double> command, mean, current;  // one period in steady state, a value a step
};

/// One 200 us step of the staircase; its mean terminal voltage.
double two_periods(Motor& motor, const Case& c, double u) {
  const Modulation modulation{kPeriod, kLink, c.dead_time_s, 0.0, false};
  double mean = 0.0;
  for (int half = 0; half < 2; ++half) {
    if (c.supply == Supply::mean) {
      motor.advance({u, 0.0}, 0.0);
      mean += 0.5 * u;
    } else {
      const Switching s = switching(modulation, {u, 0.0}, motor.outputs().current, {});
      motor.advance(s.legs, kLink, 0.0);
      mean += 0.5 * s.mean_voltage.alpha;
    }
  }
  return mean;
}

Measured measure(const Case& c, const Band& band, double amplitude) {
  MotorSetup setup;
  setup.electrical = {6.6, 5.5, 0.475, 0.475, 0.454};
  setup.hidden.saturation_current = c.saturation_current;
  const auto motor = std::move(*make_motor(setup));
  Measured y{command(band, amplitude), std::vector<double>(band.steps), std::vector<double>(band.steps)};
  for (int period = 0; period <= band.settling; ++period) {
    for (std::size_t m = 0; m < band.steps; ++m) {
      y.current[m] = motor->outputs().current.alpha;
      y.mean[m] = two_periods(*motor, c, y.command[m]);
    }
  }
  return y;
}

/// The DFT of one line.
Complex line(const std::vector<double>& x, double omega) {
  const Complex turn = std::polar(1.0, -omega * kStaircase);
  Complex sum = 0.0, place = 1.0;
  for (std::size_t m = 0; m < x.size(); ++m) {
    if (m % 256 == 0) place = std::polar(1.0, -omega * kStaircase * static_cast<double>(m));
    sum += x[m] * place;
    place *= turn;
  }
  return sum;
}

enum class Input { command, mean };  // mean: what a held staircase has at that frequency, against the start of its steps

/// The largest relative deviation from the reference over both bands.
double deviation(const std::string& name, const Case& c, Input input) {
  const auto reference = bodeflow::test::complex_vector_of(
      bodeflow::test::reference_file("errors_in_variables/drive_cases.json")["cases"][name]["G"]);
  double worst = 0.0;
  for (std::size_t b = 0; b < 2; ++b) {
    const Band& band = b == 0 ? kLow : kHigh;
    const Measured y = measure(c, band, c.amplitudes[b]);
    for (std::size_t k = 0; k < kLines; ++k) {
      const double omega = line_omega(band, k), half = 0.5 * omega * kStaircase;
      const Complex held = std::polar(std::sin(half) / half, -half);
      const Complex u = input == Input::command ? line(y.command, omega) : line(y.mean, omega) * held;
      const Complex expected = reference[static_cast<Eigen::Index>(b * kLines + k)];
      worst = std::max(worst, std::abs(line(y.current, omega) / u - expected) / std::abs(expected));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("drive cases: an ideal supply gives the exact zero-order hold of the motor") {
  CHECK(deviation("ideal_cmd_A1.0_0.85", {{1.0, 0.85}}, Input::command) < 1e-8);
  CHECK(deviation("ideal_cmd_A4.0_8.0", {{4.0, 8.0}}, Input::command) < 1e-8);
}

TEST_CASE("drive cases: dead time without compensation, from the command and from the mean voltage") {
  const Case strong{{4.0, 8.0}, Supply::switching, kDeadTime};
  CHECK(deviation("deadtime_uncomp_switching_cmd_A4.0_8.0", strong, Input::command) < 1e-6);
  CHECK(deviation("deadtime_uncomp_switching_meas_A4.0_8.0", strong, Input::mean) < 1e-6);
}

TEST_CASE("drive cases: at the paper's level the dead time leaves nothing but ripple around zero current") {
  const Case weak{{1.0, 0.85}, Supply::switching, kDeadTime};
  CHECK(deviation("deadtime_uncomp_switching_cmd_A1.0_0.85", weak, Input::command) < 1e-6);
  CHECK(deviation("deadtime_uncomp_switching_meas_A1.0_0.85", weak, Input::mean) < 1e-6);
}

TEST_CASE("drive cases: a saturating magnetising branch, weak and strong") {
  for (const double isat : {1.2, 2.5}) {
    const std::string name = isat < 2.0 ? "saturation_tanh_isat1.2_" : "saturation_tanh_isat2.5_";
    CHECK(deviation(name + "A1.0_0.85", {{1.0, 0.85}, Supply::mean, 0.0, isat}, Input::mean) < 1e-8);
    CHECK(deviation(name + "A4.0_8.0", {{4.0, 8.0}, Supply::mean, 0.0, isat}, Input::mean) < 1e-8);
  }
}
