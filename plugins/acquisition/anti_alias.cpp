#include "anti_alias.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace bodeflow::acquisition {

numerics::Expected<numerics::StateSpace> butterworth(int order, double corner_hz) {
  const double corner = 2 * std::numbers::pi * corner_hz;
  numerics::ZeroPoleGain filter;
  filter.poles.resize(order);
  Eigen::Index at = 0;
  for (int i = 0; i < order / 2; ++i) {
    const double angle = std::numbers::pi * (2 * i + 1 + order) / (2 * order);
    const std::complex<double> pole = std::polar(corner, angle);
    filter.poles[at++] = pole;
    filter.poles[at++] = std::conj(pole);
  }
  if (order % 2 == 1) filter.poles[at] = -corner;
  filter.gain = std::pow(corner, order);
  return numerics::to_state_space(filter);
}

AnalogFilter::AnalogFilter(numerics::StateSpace model)
    : model_(std::move(model)), state_(Eigen::VectorXd::Zero(model_.states())), next_(state_) {}

void AnalogFilter::run(std::span<const double> u, std::span<double> y) {
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double input = u[n];
    y[n] = model_.C.row(0).dot(state_);
    next_.noalias() = model_.A * state_;
    next_ += model_.B.col(0) * input;
    state_.swap(next_);
  }
}

}  // namespace bodeflow::acquisition
