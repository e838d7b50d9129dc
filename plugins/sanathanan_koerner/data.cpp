#include "data.hpp"

#include <string>

#include "records/signals.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

using records::counted;
using records::short_number;

Expected<void> check_frequencies(const Eigen::VectorXd& omega) {
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    const std::string line = "line " + std::to_string(k + 1);
    if (!std::isfinite(omega[k])) return unexpected("the frequency of " + line + " is not finite");
    if (omega[k] < 0.0) return unexpected("the frequency of " + line + " is below 0");
    if (k > 0 && omega[k] == omega[k - 1]) return unexpected("the frequency of " + line + " repeats that of the line before");
    if (k > 0 && omega[k] < omega[k - 1])
      return unexpected("the frequency of " + line + " is below that of the line before; needed: frequencies that rise");
  }
  return {};
}

}  // namespace

Expected<void> check(const Data& data) {
  if (data.lines() == 0 || data.channels() == 0) return unexpected("the response has no lines");
  const bool sizes = data.response.rows() == data.lines() && data.weights.rows() == data.lines() &&
                     (data.weights.cols() == 1 || data.weights.cols() == data.channels());
  if (!sizes) return unexpected("frequencies, response and weights differ in size");
  if (auto good = check_frequencies(data.omega_rad_s); !good) return good;
  for (Eigen::Index k = 0; k < data.lines(); ++k) {
    if (!data.response.row(k).array().isFinite().all())
      return unexpected("the response is not finite at line " + std::to_string(k + 1));
    if (!data.weights.row(k).array().isFinite().all() || (data.weights.row(k).array() < 0.0).any())
      return unexpected("the weight of line " + std::to_string(k + 1) + " is below 0 or not finite");
  }
  if (data.response.isZero(0.0)) return unexpected("the response is zero at all lines: there is nothing to fit");
  if (!(weighted_norm(data) > 0.0)) return unexpected("the weights are zero wherever the response is not");
  if (!std::isfinite(weighted_norm(data))) return unexpected("the response is too large to be squared");
  return {};
}

Expected<void> check_order(const Data& data, Eigen::Index order) {
  if (order < 0) return unexpected("the order is below 0");
  Eigen::Index used = 0;
  for (Eigen::Index k = 0; k < data.lines(); ++k) {
    if ((data.weights.row(k).array() > 0.0).any()) ++used;
  }
  // Real equations against unknowns: the numerators take order + 1 a channel, the denominator `order` of all.
  const Eigen::Index unknowns = data.channels() * (order + 1) + order;
  const Eigen::Index needed = std::max((unknowns + 2 * data.channels() - 1) / (2 * data.channels()), order / 2 + 1);
  if (used < needed)
    return unexpected("order " + std::to_string(order) + " with " + counted(data.channels(), "response") + " needs at least " +
                      counted(needed, "line") + "; there are " + std::to_string(used));
  return {};
}

double weighted_norm(const Data& data) {
  return weighted_residual(data, Eigen::MatrixXcd::Zero(data.lines(), data.channels())).norm();
}

Eigen::MatrixXcd weighted_residual(const Data& data, const Eigen::MatrixXcd& model) {
  Eigen::MatrixXcd r = data.response - model;
  for (Eigen::Index i = 0; i < r.cols(); ++i) r.col(i).array() *= data.weights_of(i).array();
  return r;
}

Data lines_of(const Data& data, const std::vector<Eigen::Index>& rows) {
  return {data.omega_rad_s(rows), data.response(rows, Eigen::all), data.weights(rows, Eigen::all)};
}

}  // namespace bodeflow::sanathanan_koerner
