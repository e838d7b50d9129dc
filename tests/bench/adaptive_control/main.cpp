// One sample of the adaptive scheme - filters, estimators, design, controller - beside the self-tuning regulator of the same
// order, and the base-line loop of example 1 as a graph through loaded plugins, in one run. Prints medians; the figures in
// tests/bench/README.md come from here. Limits: 1 us a sample with 4 points, 300,000 samples/s as a graph.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "../runtime/engine.hpp"
#include "../runtime/interleave.hpp"
#include "../runtime/measure.hpp"
#include "adaptive_control/adaptive_controller.hpp"
#include "adaptive_control/pole_patterns.hpp"
#include "adaptive_control/self_tuning.hpp"

namespace {

namespace ac = bodeflow::adaptive_control;

constexpr std::size_t kSamples = 200'000;

/// The plant of example 1 as a difference equation.
class Plant {
 public:
  double output() const { return y_[0]; }
  void input(double u) {
    for (std::size_t i = 4; i > 0; --i) u_[i] = u_[i - 1];
    u_[0] = u;
    double y = 0.0;
    for (std::size_t i = 0; i < 5; ++i) y += kB[i] * u_[i] - kA[i] * y_[i];
    for (std::size_t i = 4; i > 0; --i) y_[i] = y_[i - 1];
    y_[0] = y;
  }

 private:
  static constexpr double kB[5] = {0.0036598468273437, 0.0422612584882861, 0.0469189012484365, 0.0079547661266056,
                                   0.0001304175841900};
  static constexpr double kA[5] = {-1.8393972058572072, 1.3533528323661197, -0.4978706836786345, 0.0915781944436694,
                                   -0.0067379469990855};
  double u_[5] = {}, y_[5] = {};
};

std::shared_ptr<ac::AdaptiveController> adaptive(std::vector<double> omega, int order) {
  ac::BankSettings bank;
  bank.omega = omega;
  bank.delays = {2};
  ac::DesignerSettings design;
  design.structure.omega = std::move(omega);
  design.structure.n_r = design.structure.n_s = order;
  design.structure.r_p = Eigen::Vector2d(1.0, -1.0);
  design.structure.s_p = Eigen::VectorXd::Ones(1);
  design.desired = {ac::dominant_poles(5, 0.5, 3.0), ac::bessel(order, 0.4), 0.0};
  design.start = 80;
  design.start_gain = 1.0;
  return std::make_shared<ac::AdaptiveController>(*ac::EstimatorBank::make(bank), *ac::Designer::make(design),
                                                  ac::RstController(-10, 10));
}

std::shared_ptr<ac::SelfTuningRegulator> self_tuning() {
  ac::SelfTuningSettings s;
  s.a_m = s.a_o = ac::bessel(2, 0.5);
  return std::make_shared<ac::SelfTuningRegulator>(*ac::SelfTuningRegulator::make(s));
}

double command(std::size_t k) { return (k / 30) % 2 == 0 ? 1.0 : -1.0; }

template <class Controller>
void run(Controller& controller) {
  Plant plant;
  for (std::size_t k = 0; k < kSamples; ++k) plant.input(controller.step(plant.output(), command(k)));
}

/// Nanoseconds of single steps, the two looks at the clock included.
std::vector<double> single_steps(ac::AdaptiveController& controller) {
  Plant plant;
  std::vector<double> times;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double begin = bench::now_ns();
    const double u = controller.step(plant.output(), command(k));
    times.push_back(bench::now_ns() - begin);
    plant.input(u);
  }
  return times;
}

std::string graph() {
  return fmt::format(
      "bodeflow: 1\nrun: {{duration: {} s}}\nblocks:\n"
      "  command: {{block: generators.prbs, sample_rate: 1 Hz, bits: 7, hold: 30}}\n"
      "  estimator: {{block: adaptive_control.estimator, frequencies: [0.1, 0.3, 0.7], delays: [2]}}\n"
      "  design: {{block: adaptive_control.design, frequencies: [0.1, 0.3, 0.7], desired: {{order: 5, ratio: 3, bandwidth: "
      "0.5}}, start: 80, "
      "start_gain: 1}}\n"
      "  controller: {{block: adaptive_control.rst}}\n"
      "  plant: {{block: plants.linear, numerator: [1], denominator: [1, 5, 10, 10, 5, 1]}}\n"
      "  sink: {{block: bench.sink}}\n"
      "connections:\n  - command -> controller.setpoint\n  - plant -> controller.y\n  - plant -> estimator.y\n"
      "  - controller.u -> estimator.u\n  - estimator.response -> design.response\n  - command -> design.setpoint\n"
      "  - plant -> design.y\n  - design.coefficients -> controller.coefficients\n  - controller.u -> plant\n  - plant -> sink\n",
      kSamples);
}

}  // namespace

int main(int count, char** arguments) {
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 7;
  std::vector<bench::Candidate> candidates;
  candidates.push_back({"adaptive scheme, 4 points, order 2", [] { run(*adaptive({0.1, 0.3, 0.5, 0.7}, 2)); }, {}, {}});
  candidates.push_back({"adaptive scheme, 3 points, order 2", [] { run(*adaptive({0.1, 0.3, 0.7}, 2)); }, {}, {}});
  candidates.push_back({"adaptive scheme, 4 points, order 3", [] { run(*adaptive({0.1, 0.3, 0.5, 0.7}, 3)); }, {}, {}});
  candidates.push_back({"self-tuning regulator, order 2", [] { run(*self_tuning()); }, {}, {}});
  const auto engine = std::make_shared<bench::Engine>(graph(), bench::EngineOptions{1, 1024, false});
  candidates.push_back({"graph of example 1: 6 blocks in a loop, 3 points, loaded plugins", [=] { engine->run(); }, {}, {}});
  bench::interleave(candidates, kSamples, repeats);
  bench::print("adaptive control with all nets; ns a sample, plant included", candidates);
  auto times = single_steps(*adaptive({0.1, 0.3, 0.5, 0.7}, 2));
  fmt::print("one step, 4 points, order 2: median {:.0f} ns, 99 % {:.0f} ns, clock included\n", bench::median(times),
             bench::quantile(times, 0.99));
}
