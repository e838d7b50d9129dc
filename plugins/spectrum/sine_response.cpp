#include "sine_response.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace bodeflow::spectrum {

Expected<SineResponse> sine_response(const Eigen::Ref<const Eigen::VectorXcd>& input,
                                     const Eigen::Ref<const Eigen::MatrixXcd>& output) {
  if (input.size() < 2) return unexpected("the variance needs at least 2 windows; found " + std::to_string(input.size()));
  SineResponse r;
  r.windows = input.size();
  const auto count = static_cast<double>(r.windows);
  const double scale = 1.0 / (count * (count - 1.0));
  r.input_mean = input.sum() / count;
  const double power = std::norm(r.input_mean);
  if (!(power > 0.0)) return unexpected("the input is zero");
  const Eigen::VectorXcd du = input.array() - r.input_mean;
  r.input_variance = scale * du.squaredNorm();
  const Eigen::Index outputs = output.cols();
  for (auto* v : {&r.output_mean, &r.cross_covariance, &r.response}) v->resize(outputs);
  for (auto* v : {&r.output_variance, &r.variance}) v->resize(outputs);
  for (Eigen::Index i = 0; i < outputs; ++i) {
    const std::complex<double> y = output.col(i).sum() / count, g = y / r.input_mean;
    const Eigen::VectorXcd dy = output.col(i).array() - y;
    r.output_mean[i] = y;
    r.output_variance[i] = scale * dy.squaredNorm();
    r.cross_covariance[i] = scale * du.dot(dy);
    r.response[i] = g;
    // Below zero by rounding alone.
    r.variance[i] = std::max(0.0, r.output_variance[i] + std::norm(g) * r.input_variance -
                                      2.0 * std::real(std::conj(g) * r.cross_covariance[i])) /
                    power;
    if (!std::isfinite(std::norm(g)) || !std::isfinite(r.variance[i])) return unexpected("the values are too large");
  }
  return r;
}

}  // namespace bodeflow::spectrum
