#include "simulator.hpp"

#include <algorithm>
#include <array>

namespace bodeflow::plants {
namespace {

std::vector<double> row_major(const Eigen::MatrixXd& m) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(m.size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) values.push_back(m(i, j));
  }
  return values;
}

}  // namespace

Simulator::Simulator(const numerics::StateSpace& system, const std::vector<double>& initial, bool late)
    : states_(static_cast<std::size_t>(system.states())),
      inputs_(static_cast<std::size_t>(system.inputs())),
      outputs_(static_cast<std::size_t>(system.outputs())),
      late_(late),
      a_(row_major(system.A)),
      b_(row_major(system.B)),
      c_(row_major(system.C)),
      d_(row_major(system.D)),
      initial_(initial),
      x_(initial),
      next_(initial.size()),
      y_(outputs_) {}

void Simulator::run(const double* const* inputs, double* const* outputs, std::size_t count) {
  if (inputs_ != 1 || outputs_ != 1) return run_general(inputs, outputs, count);
  switch (states_) {
    case 1:
      return run_single<1>(inputs[0], outputs[0], count);
    case 2:
      return run_single<2>(inputs[0], outputs[0], count);
    case 3:
      return run_single<3>(inputs[0], outputs[0], count);
    case 4:
      return run_single<4>(inputs[0], outputs[0], count);
    case 5:
      return run_single<5>(inputs[0], outputs[0], count);
    case 6:
      return run_single<6>(inputs[0], outputs[0], count);
    default:
      return run_general(inputs, outputs, count);
  }
}

void Simulator::reset() {
  x_ = initial_;
  begun_ = false;
}

// One input, one output and a few states: the state stays in registers, and every loop is unrolled.
template <int kStates>
void Simulator::run_single(const double* u, double* y, std::size_t count) {
  const double* const a = a_.data();
  const double* const b = b_.data();
  const double* const c = c_.data();
  std::array<double, kStates> x;
  std::copy_n(x_.begin(), x.size(), x.begin());
  const double d = d_[0];
  const auto advance = [&](double input) {
    std::array<double, kStates> next;
    for (std::size_t i = 0; i < kStates; ++i) {
      double sum = b[i] * input;
      for (std::size_t j = 0; j < kStates; ++j) sum += a[i * kStates + j] * x[j];
      next[i] = sum;
    }
    x = next;
  };
  const auto output = [&](double input) {
    double sum = d * input;
    for (std::size_t j = 0; j < kStates; ++j) sum += c[j] * x[j];
    return sum;
  };
  for (std::size_t n = 0; n < count; ++n) {
    const double input = u[n];
    if (late_) {
      if (begun_) advance(input);
      begun_ = true;
      y[n] = output(0.0);
    } else {
      y[n] = output(input);
      advance(input);
    }
  }
  std::copy(x.begin(), x.end(), x_.begin());
}

void Simulator::run_general(const double* const* inputs, double* const* outputs, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) {
    if (late_ && begun_) advance(inputs, n);
    begun_ = true;
    for (std::size_t i = 0; i < outputs_; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < inputs_ && !late_; ++j) sum += d_[i * inputs_ + j] * inputs[j][n];
      for (std::size_t j = 0; j < states_; ++j) sum += c_[i * states_ + j] * x_[j];
      y_[i] = sum;
    }
    if (!late_) advance(inputs, n);
    for (std::size_t i = 0; i < outputs_; ++i) outputs[i][n] = y_[i];
  }
}

void Simulator::advance(const double* const* inputs, std::size_t n) {
  for (std::size_t i = 0; i < states_; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < inputs_; ++j) sum += b_[i * inputs_ + j] * inputs[j][n];
    for (std::size_t j = 0; j < states_; ++j) sum += a_[i * states_ + j] * x_[j];
    next_[i] = sum;
  }
  x_.swap(next_);
}

}  // namespace bodeflow::plants
