#pragma once

#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <bodeflow/numerics/random.hpp>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "adaptive_control/adaptive_controller.hpp"
#include "adaptive_control/closed_loop.hpp"
#include "adaptive_control/pole_patterns.hpp"

namespace bodeflow::test {

namespace ac = adaptive_control;

/// The columns of a CSV file with one header line.
inline std::map<std::string, std::vector<double>> csv_columns(const std::string& path) {
  std::ifstream file(path);
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::stringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(file, line)) {
    std::size_t i = 0;
    for (std::stringstream cells(line); std::getline(cells, cell, ',');) columns[names[i++]].push_back(std::stod(cell));
  }
  return columns;
}

inline Eigen::VectorXd poly(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

/// A plant behind a zero-order hold, sample by sample.
class SimulatedPlant {
 public:
  SimulatedPlant(const numerics::TransferFunction& plant, double delay_s, double h = 1.0)
      : model_(*numerics::zero_order_hold(*numerics::to_state_space(plant), h, delay_s)),
        x_(Eigen::VectorXd::Zero(model_.model.states())),
        late_(static_cast<std::size_t>(model_.delay), 0.0) {}

  double output() const { return (model_.model.C * x_)(0, 0); }
  void input(double u) {
    late_.insert(late_.begin(), u);
    x_ = model_.model.A * x_ + model_.model.B * late_.back();
    late_.pop_back();
  }

 private:
  numerics::DelayedModel model_;
  Eigen::VectorXd x_;
  std::vector<double> late_;
};

/// +-1 from a register of 7 stages, as the reference runs have it: a new bit every `clock` samples.
class Command {
 public:
  explicit Command(int clock) : clock_(clock) {}
  double next() {
    if (held_ == 0) {
      const unsigned bit = ((state_ >> 6) ^ (state_ >> 5)) & 1u;
      state_ = ((state_ << 1) | bit) & 0x7fu;
      value_ = bit != 0 ? -1.0 : 1.0;
      held_ = clock_;
    }
    --held_;
    return value_;
  }

 private:
  int clock_, held_ = 0;
  unsigned state_ = 0x7f;
  double value_ = 0.0;
};

/// One of the thesis' examples, with the settings that reproduce it.
struct Example {
  numerics::TransferFunction plant;
  double delay = 0.0;
  ac::BankSettings bank;
  ac::DesignerSettings design;
  int clock = 30;
};

/// The plain scheme of the thesis: no nets.
inline void without_nets(Example& e) {
  e.bank.point.gate = e.bank.point.bound = e.bank.point.huber = false;
  e.bank.point.warm_up = 0;
  e.design.checks = false;
  e.design.ladder_steps = 1;
  e.design.rate = 1.0;
}

inline Example example(const numerics::TransferFunction& plant, double delay, std::vector<double> omega, int d, int order,
                       const Eigen::VectorXd& a_m, double tau_m, const Eigen::VectorXd& a_o, double start_gain) {
  Example e;
  e.plant = plant;
  e.delay = delay;
  e.bank.omega = e.design.structure.omega = std::move(omega);
  e.bank.delays = {d};
  e.design.structure.n_r = e.design.structure.n_s = order;
  e.design.structure.r_p = poly({1, -1});
  e.design.structure.s_p = poly({1});
  e.design.desired = {a_m, a_o, tau_m};
  e.design.start = 80;
  e.design.start_gain = start_gain;
  return e;
}

inline numerics::TransferFunction fifth_order(double gain = 1.0) { return {poly({gain}), poly({1, 5, 10, 10, 5, 1}), 0.0}; }

inline Example example_1(double w_m = 0.5, double w_o = 0.5) {
  return example(fifth_order(), 0, {0.1, 0.3, 0.7}, 2, 2, numerics::multiply(ac::bessel(2, w_m), ac::bessel(3, 3 * w_m)), 0,
                 ac::bessel(2, w_o), 1.0);
}

inline Example example_1_third_order() {
  return example(fifth_order(), 0, {0.1, 0.3, 0.5, 0.7}, 2, 3, numerics::multiply(ac::bessel(2, 0.65), ac::bessel(3, 3 * 0.65)),
                 0, ac::bessel(3, 0.325), 1.0);
}

inline Example example_2() {
  Example e = example({poly({-2, 1}), poly({1, 5, 10, 10, 5, 1}), 0.0}, 0, {0.05, 0.15, 0.3, 0.4}, 5, 2,
                      numerics::multiply(ac::bessel(2, 0.6), ac::bessel(2, 1.8)), 3, ac::bessel(2, 0.3), 0.5);
  e.clock = 40;
  return e;
}

inline Example example_3(int order) {
  const double w_m = order == 2 ? 0.65 : 1.0;
  return example({poly({1}), poly({1, 2, 1}), 0.0}, 5, {0.05, 0.15, 0.3, 0.45}, 6, order, ac::real_poles(2, w_m), 5,
                 ac::bessel(order, 0.5 * w_m), 0.5);
}

inline Example example_4() {
  Example e = example({poly({1}), poly({1, 1, 1, 0}), 0.0}, 2, {0.2, 0.3, 0.5, 0.7}, 3, 3,
                      numerics::multiply(ac::bessel(2, 0.7), ac::bessel(3, 2.8)), 2, ac::bessel(3, 0.7), 0.15);
  e.clock = 50;
  e.design.limits.sensitivity = 4.0;
  return e;
}

/// What goes on around the loop.
struct Conditions {
  int samples = 500;
  int load_at = 1 << 30;  ///< unit load at the plant's input from here on
  double load = 1.0;
  double noise = 0.0;  ///< standard deviation at the output
  std::uint64_t seed = 1;
  double limit = 1e300;                ///< of |u|
  std::function<double(int)> gain;     ///< of the plant, 1 where empty
  std::function<double(int)> command;  ///< in place of the example's sequence
  bool watched = true;                 ///< by the designer
  bool known_plant = false;            ///< a controller designed with the true response from the start sample on
};

struct Run {
  std::vector<double> u_c, y, u, y_m;
  std::vector<std::vector<std::complex<double>>> response;  ///< estimates, sample by sample
  bool adapted = false;                                     ///< a designed controller came into use

  double rms(int from, int to) const {
    double sum = 0.0;
    for (int k = from; k < to; ++k) sum += std::pow(y[static_cast<std::size_t>(k)] - y_m[static_cast<std::size_t>(k)], 2);
    return std::sqrt(sum / (to - from));
  }
  double largest_u(int from, int to) const {
    double largest = 0.0;
    for (int k = from; k < to; ++k) largest = std::max(largest, std::abs(u[static_cast<std::size_t>(k)]));
    return largest;
  }
};

inline std::vector<std::complex<double>> true_response(const Example& e) {
  return *ac::sampled_response(e.plant, e.delay, 1.0, e.design.structure.omega);
}

inline Run run(const Example& e, const Conditions& c) {
  auto bank = ac::EstimatorBank::make(e.bank);
  auto designer = ac::Designer::make(e.design);
  if (!bank || !designer) throw std::runtime_error(!bank ? bank.error().text : designer.error().text);
  ac::RstController controller(-c.limit, c.limit);
  SimulatedPlant plant(e.plant, e.delay), desired(ac::undelayed(e.design.desired), e.design.desired.delay_s);
  numerics::Random random(c.seed);
  Command command(e.clock);
  const auto truth = true_response(e);
  Run r;
  double u_late = 0.0;
  for (int k = 0; k < c.samples; ++k) {
    const double u_c = c.command ? c.command(k) : command.next();
    const double y = plant.output() * (c.gain ? c.gain(k) : 1.0) + (c.noise > 0.0 ? c.noise * random.normal() : 0.0);
    r.u_c.push_back(u_c);
    r.y.push_back(y);
    r.y_m.push_back(desired.output());
    desired.input(u_c);
    bank->step(y, u_late, u_c);
    r.response.emplace_back(bank->response(), bank->response() + bank->points());
    if (c.watched) designer->watch(y, u_c, controller.at_limit());
    const ac::Rst& rst = designer->step(c.known_plant ? truth.data() : bank->response());
    u_late = controller.step(y, u_c, rst, designer->anti_windup());
    r.u.push_back(u_late);
    plant.input(u_late + (k >= c.load_at ? c.load : 0.0));
  }
  r.adapted = designer->adapted();
  return r;
}

}  // namespace bodeflow::test
