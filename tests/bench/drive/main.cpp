// The switching drive at 10 kHz PWM with dead time and compensation, at standstill and turning: the algorithms in a plain loop,
// and the same as a graph through loaded plugins, interleaved in one run. Prints medians; the figures in tests/bench/README.md
// come from here. The limit is 0.5 us a PWM period: 200 times real time.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "../runtime/engine.hpp"
#include "../runtime/interleave.hpp"
#include "drive/motor.hpp"
#include "drive/pwm.hpp"

namespace {

using namespace bodeflow::drive;

constexpr std::size_t kPeriods = 1'000'000;
constexpr double kPeriod = 1e-4;

std::string graph(bool turning) {
  const char* supply =
      turning
          ? "{block: drive.supply, sample_rate: 10 kHz, voltage: 180 V, frequency: 50 Hz}"
          : "{block: generators.multisine, sample_rate: 5 kHz, period: 2560, lines: {first: 3, last: 49, step: 2}, amplitude: 8}";
  return fmt::format(
      "bodeflow: 1\nrun: {{duration: {} s}}\nblocks:\n"
      "  supply: {}\n  hold: {{block: filters.hold, factor: {}}}\n"
      "  inverter: {{block: drive.inverter, dead_time: 1.5 us, compensation: sign, modulation: min_max}}\n"
      "  motor: {{block: drive.induction_motor, rs: 6.6, rr: 5.5, ls: 0.475, lr: 0.475, lm: 0.454, inertia: 0.004}}\n"
      "  sink: {{block: bench.sink}}\n"
      "connections:\n  - supply -> hold -> inverter.reference\n  - inverter.legs -> motor.legs\n"
      "  - motor.current -> inverter.current\n  - motor.current -> inverter.measured_current\n  - motor.speed -> sink\n",
      kPeriods * kPeriod, supply, turning ? 1 : 2);
}

std::unique_ptr<Motor> motor(bool turning) {
  return std::move(*make_motor({{6.6, 5.5, 0.475, 0.475, 0.454}, {}, {1.0, 0.004, 0.0, 0.0, !turning}, kPeriod}));
}

/// The voltage of a period of the excitation: 24 lines, or a vector that turns at 50 Hz.
std::vector<AlphaBeta> reference(bool turning) {
  std::vector<AlphaBeta> u(turning ? 200 : 5120);
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double step = 2.0 * std::numbers::pi * static_cast<double>(turning ? n : n / 2 * 2) / static_cast<double>(u.size());
    if (turning) u[n] = {254.5 * std::cos(step), 254.5 * std::sin(step)};
    for (int i = 1; !turning && i <= 24; ++i)
      u[n].alpha += 8.0 * std::cos((2 * i + 1) * step - std::numbers::pi * i * (i - 1) / 24);
  }
  return u;
}

void run(Motor& m, const std::vector<AlphaBeta>& u) {
  const Modulation modulation{kPeriod, 540.0, 1.5e-6, 1.5e-6, true};
  for (std::size_t n = 0; n < kPeriods; ++n) {
    const AlphaBeta i = m.outputs().current;
    m.advance(switching(modulation, u[n % u.size()], i, i).legs, modulation.dc_link_v, 0.0);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 7;
  for (const bool turning : {false, true}) {
    const auto u = reference(turning);
    const std::shared_ptr<Motor> m = motor(turning);
    const auto engine = std::make_shared<bench::Engine>(graph(turning), bench::EngineOptions{1, 1024, false});
    std::vector<bench::Candidate> candidates;
    candidates.push_back({"graph: hold -> inverter <-> motor, loaded plugins", [=] { engine->run(); }, {}, {}});
    candidates.push_back({"algorithms in a plain loop", [=] { run(*m, u); }, {}, {}});
    bench::interleave(candidates, kPeriods, repeats);
    bench::print(fmt::format("switching drive with dead time, {}; ns a PWM period of 100,000 ns",
                             turning ? "three phases, turning" : "one phase, standstill"),
                 candidates);
  }
}
