#include "shaping_filter.hpp"

#include <Eigen/LU>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

#include "phase.hpp"
#include "portable_exp.hpp"

namespace bodeflow::generators {
namespace {

using numerics::StateSpace;

constexpr double kSectionsPerDecade = 3;

}  // namespace

numerics::Expected<StateSpace> rational_filter(const Eigen::VectorXd& numerator, const Eigen::VectorXd& denominator) {
  auto filter = numerics::to_state_space(numerics::TransferFunction{numerator, denominator, 1.0});
  if (!filter) return filter;
  const auto poles = numerics::roots(denominator);
  if (!poles) return tl::make_unexpected(poles.error());
  const double largest = poles->size() > 0 ? poles->cwiseAbs().maxCoeff() : 0.0;
  if (!(largest < 1)) {
    return numerics::refused("the noise filter has a pole of magnitude " + std::to_string(largest) +
                             "; allowed: below 1, else the noise grows without end");
  }
  return filter;
}

StateSpace power_law_filter(double exponent, double lowest) {
  const double step = portable_exp(std::numbers::ln10 / kSectionsPerDecade);
  const double to_zero = portable_exp(exponent * std::numbers::ln10 / (2 * kSectionsPerDecade));
  std::vector<double> poles, zeros;
  for (double frequency = lowest; frequency < 0.5; frequency *= step) {
    poles.push_back(portable_exp(-2 * std::numbers::pi * frequency));
    zeros.push_back(portable_exp(-2 * std::numbers::pi * frequency * to_zero));
  }
  // A cascade of s[n+1] = p s[n] + u[n], y[n] = u[n] + (p - z) s[n]: section i has the input e + sum_{j<i} (p_j - z_j) s_j.
  const auto size = static_cast<Eigen::Index>(poles.size());
  StateSpace filter{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Ones(size, 1), Eigen::MatrixXd::Zero(1, size),
                    Eigen::MatrixXd::Ones(1, 1), 1.0};
  for (Eigen::Index j = 0; j < size; ++j) {
    const double share = poles[static_cast<std::size_t>(j)] - zeros[static_cast<std::size_t>(j)];
    filter.A(j, j) = poles[static_cast<std::size_t>(j)];
    for (Eigen::Index i = j + 1; i < size; ++i) filter.A(i, j) = share;
    filter.C(0, j) = share;
  }
  return filter;
}

Eigen::MatrixXd stationary_covariance(const StateSpace& filter) {
  Eigen::MatrixXd power = filter.A;
  Eigen::MatrixXd covariance = filter.B * filter.B.transpose();
  // A pole at 1 - 2^-53 has faded after 2^60 samples.
  for (int doubling = 0; doubling < 60 && !power.isZero(0); ++doubling) {
    const Eigen::MatrixXd added = power * covariance * power.transpose();
    covariance += added;
    power = (power * power).eval();
  }
  return 0.5 * (covariance + covariance.transpose());
}

Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& covariance) {
  const Eigen::Index size = covariance.rows();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    const double left = covariance(j, j) - root.row(j).head(j).squaredNorm();
    // What is left of a variance below its rounding is none.
    if (!(left > 1e-14 * covariance(j, j))) continue;
    root(j, j) = std::sqrt(left);
    for (Eigen::Index i = j + 1; i < size; ++i)
      root(i, j) = (covariance(i, j) - root.row(i).head(j).dot(root.row(j).head(j))) / root(j, j);
  }
  return root;
}

double output_std(const StateSpace& filter, const Eigen::MatrixXd& covariance) {
  const double through_states = filter.states() > 0 ? (filter.C * covariance * filter.C.transpose())(0, 0) : 0.0;
  return std::sqrt(through_states + filter.D(0, 0) * filter.D(0, 0));
}

double gain_at(const StateSpace& filter, double frequency) {
  if (filter.states() == 0) return std::abs(filter.D(0, 0));
  const Eigen::Index size = filter.states();
  const Eigen::MatrixXcd resolvent = turn_of_cycles(frequency) * Eigen::MatrixXcd::Identity(size, size) - filter.A;
  const Eigen::VectorXcd states = resolvent.partialPivLu().solve(filter.B.cast<std::complex<double>>());
  return std::abs((filter.C * states)(0, 0) + filter.D(0, 0));
}

}  // namespace bodeflow::generators
