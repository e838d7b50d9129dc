#include "modes.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "mode_covariance.hpp"
#include "sanathanan_koerner/identification.hpp"

namespace bodeflow::validation {
namespace {

using namespace sanathanan_koerner;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kEnough = 0.01;       // probability below which a residual is more than the variance
constexpr double kLeastWeight = 1e-6;  // of relative weights: |G| below that share of the largest counts as it

Data data_of(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXcd& response, const Eigen::VectorXd& variance, bool known) {
  Data d{kTwoPi * frequency_hz, response, {}};
  const Eigen::VectorXd size = response.cwiseAbs();
  d.weights =
      known ? variance.cwiseSqrt().cwiseInverse().eval() : size.cwiseMax(kLeastWeight * size.maxCoeff()).cwiseInverse().eval();
  return d;
}

/// The order with the least description length.
Expected<Eigen::Index> order_of(const Data& data, const Settings& settings, Eigen::Index highest) {
  const double F = static_cast<double>(data.lines());
  const double floor = std::pow(1e-12 * weighted_norm(data), 2);
  double least = INFINITY;
  Eigen::Index best = 0, enough = highest;
  std::string why = "no order";
  for (Eigen::Index order = 1; order <= std::min(highest, enough + kBeyond); ++order) {
    const double parameters = static_cast<double>(2 * order + 1);
    if (parameters >= 2.0 * F) break;
    const auto one = fitted(data, settings, order, 1);
    if (!one) {
      why = one.error().text;
      continue;
    }
    const double cost = std::max(floor, weighted_residual(data, one->response).squaredNorm());
    const double likelihood = settings.known_variance ? 2.0 * cost : 2.0 * F * std::log(cost / F);
    const double length = likelihood + parameters * std::log(2.0 * F);
    if (length < least) best = order;
    least = std::min(least, length);
    const bool explained =
        settings.known_variance ? numerics::chi_squared_tail(2.0 * cost, 2.0 * F - parameters) > kEnough : cost <= floor;
    if (explained) enough = std::min(enough, order);
  }
  if (best == 0) return unexpected("no model of the response: " + why);
  return best;
}

double gradient_variance(const Eigen::Matrix2d& c, double re, double im) {
  return Eigen::Vector2d(re, im).dot(c * Eigen::Vector2d(re, im));
}

}  // namespace

double Mode::frequency_hz() const { return std::abs(pole) / kTwoPi; }
double Mode::damping() const { return -pole.real() / std::abs(pole); }
double Mode::frequency_variance() const {
  const double size = std::abs(pole);
  return gradient_variance(covariance, pole.real() / size, pole.imag() / size) / (kTwoPi * kTwoPi);
}
double Mode::damping_variance() const {
  const double cube = std::pow(std::abs(pole), 3);
  return gradient_variance(covariance, -pole.imag() * pole.imag() / cube, pole.real() * pole.imag() / cube);
}

Expected<FittedModes> fit_modes(const Eigen::VectorXd& f, const Eigen::VectorXcd& response, const Eigen::VectorXd& variance,
                                const ModeSettings& wanted) {
  const bool known = variance.minCoeff() > 0.0;
  const Data data = data_of(f, response, variance, known);
  if (auto good = check(data); !good) return unexpected(good.error().text);
  Settings settings;
  settings.known_variance = known;
  settings.order = wanted.order;
  if (!settings.order) {
    const auto order = order_of(data, settings, wanted.highest_order);
    if (!order) return unexpected(order.error().text);
    settings.order = *order;
  }
  settings.refine = true;
  auto id = identify(data, settings);
  if (!id) {  // a refinement can lose a pole that lies far beyond the lines
    settings.refine = false;
    id = identify(data, settings);
  }
  if (!id) return unexpected(id.error().text);
  FittedModes m;
  m.order = id->order;
  m.response = id->response.col(0);
  const double left = static_cast<double>(id->equations) - 0.5 * static_cast<double>(id->parameters);
  m.fit = known && left > 0.0 ? id->cost / left : kNaN;
  std::vector<std::complex<double>> resonances;
  for (const std::complex<double> pole : id->poles) {
    const double size = std::abs(pole) / kTwoPi;
    if (pole.imag() > 0.0 && size >= f[0] && size <= f[f.size() - 1]) {
      resonances.push_back(pole);
    } else if (!(pole.imag() < 0.0)) {
      ++m.other_poles;
    }
  }
  const auto covariances = mode_covariances(data, id->poles, resonances);
  if (!covariances) m.no_covariance = covariances.error().text;
  const double residual = known ? std::max(1.0, m.fit) : left > 0.0 ? id->cost / left : kNaN;
  for (std::size_t i = 0; i < resonances.size(); ++i)
    m.modes.push_back(
        {resonances[i], covariances ? Eigen::Matrix2d(residual * (*covariances)[i]) : Eigen::Matrix2d::Constant(kNaN)});
  std::sort(m.modes.begin(), m.modes.end(), [](const Mode& a, const Mode& b) { return a.frequency_hz() < b.frequency_hz(); });
  return m;
}

}  // namespace bodeflow::validation
