#include "bodeflow/numerics/frequency_response.hpp"

#include <Eigen/LU>
#include <numbers>

#include "bodeflow/numerics/balance.hpp"
#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {

using Complex = std::complex<double>;

Complex frequency_point(double frequency_hz, double sample_time) {
  const double omega = 2 * std::numbers::pi * frequency_hz;
  return sample_time == 0 ? Complex(0, omega) : std::polar(1.0, omega * sample_time);
}

Eigen::VectorXcd frequency_response(const TransferFunction& system, const Eigen::VectorXd& frequency_hz) {
  return frequency_hz.unaryExpr([&](double f) {
    const Complex x = frequency_point(f, system.sample_time);
    return evaluate(system.numerator, x) / evaluate(system.denominator, x);
  });
}

Eigen::VectorXcd frequency_response(const ZeroPoleGain& system, const Eigen::VectorXd& frequency_hz) {
  return frequency_hz.unaryExpr([&](double f) {
    const Complex x = frequency_point(f, system.sample_time);
    Complex value = system.gain;
    // A zero and a pole by turns: the product stays in range where the numerator alone would not.
    for (Eigen::Index k = 0; k < std::max(system.zeros.size(), system.poles.size()); ++k) {
      if (k < system.zeros.size()) value *= x - system.zeros[k];
      if (k < system.poles.size()) value /= x - system.poles[k];
    }
    return value;
  });
}

std::vector<Eigen::MatrixXcd> frequency_response(const StateSpace& system, const Eigen::VectorXd& frequency_hz) {
  const Eigen::VectorXd scales = balancing_scales(system.A);
  const Eigen::MatrixXcd A = scaled_by(system.A, scales).cast<Complex>();
  const Eigen::MatrixXcd B = (scales.cwiseInverse().asDiagonal() * system.B).cast<Complex>();
  const Eigen::MatrixXcd C = (system.C * scales.asDiagonal()).cast<Complex>();
  std::vector<Eigen::MatrixXcd> response;
  response.reserve(static_cast<std::size_t>(frequency_hz.size()));
  for (const double f : frequency_hz) {
    Eigen::MatrixXcd value = system.D.cast<Complex>();
    if (system.states() > 0) {
      Eigen::MatrixXcd resolvent = -A;
      resolvent.diagonal().array() += frequency_point(f, system.sample_time);
      value += C * resolvent.partialPivLu().solve(B);
    }
    response.push_back(std::move(value));
  }
  return response;
}

}  // namespace bodeflow::numerics
