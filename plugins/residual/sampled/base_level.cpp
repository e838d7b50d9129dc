#include "sampled/base_level.hpp"

#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

constexpr double kStep = 1e-5;
constexpr numerics::LeastSquaresLimits kLimits{30, 1e-6};

double value_of(const FitParameter& p, double coordinate) { return p.logarithmic ? std::exp(coordinate) : coordinate * p.scale; }
double coordinate_of(const FitParameter& p, double value) { return p.logarithmic ? std::log(value) : value / p.scale; }

}  // namespace

Expected<Eigen::VectorXd> fit_base(const JointModel& base, const Measurement& record,
                                   const std::vector<std::vector<double>>& starts) {
  const std::vector<FitParameter> parameters = base.parameters();
  const auto count = static_cast<Eigen::Index>(parameters.size());
  const auto values = [&](const Eigen::VectorXd& c) {
    Eigen::VectorXd v(count);
    for (Eigen::Index i = 0; i < count; ++i) v[i] = value_of(parameters[static_cast<std::size_t>(i)], c[i]);
    return v;
  };
  const auto residual = [&](const Eigen::VectorXd& c) { return record.residual(base, values(c)); };
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& start : starts) {
    Eigen::VectorXd c(count);
    for (Eigen::Index i = 0; i < count; ++i)
      c[i] = coordinate_of(parameters[static_cast<std::size_t>(i)], start[static_cast<std::size_t>(i)]);
    const double cost = residual(c).squaredNorm();
    if (!(cost < least)) continue;
    least = cost;
    best = c;
  }
  if (best.size() == 0) return refused("the base model can't be computed at any of the parameters to start from");
  const numerics::LeastSquaresProblem problem{record.rows(),
                                              [&](const Eigen::VectorXd& c, Eigen::VectorXd& r) { r = residual(c); },
                                              [&](const Eigen::VectorXd& c, Eigen::MatrixXd& j) {
                                                const Eigen::VectorXd here = residual(c);
                                                for (Eigen::Index i = 0; i < count; ++i) {
                                                  Eigen::VectorXd moved = c;
                                                  moved[i] += kStep;
                                                  j.col(i) = (residual(moved) - here) / kStep;
                                                }
                                              }};
  const auto found = numerics::levenberg_marquardt(problem, best, kLimits);
  return values(found ? found->parameters : best);
}

}  // namespace bodeflow::residual
