#pragma once

#include <bodeflow/numerics/linear_system.hpp>
#include <cstddef>
#include <vector>

namespace bodeflow::plants {

/// Steps a discrete-time system: y[n] = C x[n] + D u[n], x[n+1] = A x[n] + B u[n]. Sums run in one fixed order (inputs, then
/// states), so the bits do not depend on how many samples a call takes.
class Simulator {
 public:
  Simulator() = default;
  /// initial: x[0], one value a state. `late`: the caller hands over u[n-1] in place of u[n], which a system without feed-through
  /// allows: the state is brought up to sample n first; the first sample of all is not used.
  Simulator(const numerics::StateSpace& system, const std::vector<double>& initial, bool late);

  /// Takes `count` samples of each input and gives as many of each output: pointers to channels. Allocates nothing. Outputs may
  /// share memory with inputs.
  void run(const double* const* inputs, double* const* outputs, std::size_t count);

  /// Back to x[0].
  void reset();

 private:
  template <int kStates>
  void run_single(const double* u, double* y, std::size_t count);
  void run_general(const double* const* inputs, double* const* outputs, std::size_t count);
  void advance(const double* const* inputs, std::size_t n);

  std::size_t states_ = 0;
  std::size_t inputs_ = 0;
  std::size_t outputs_ = 0;
  bool late_ = false;
  bool begun_ = false;
  std::vector<double> a_, b_, c_, d_;  // row-major
  std::vector<double> initial_, x_, next_, y_;
};

}  // namespace bodeflow::plants
