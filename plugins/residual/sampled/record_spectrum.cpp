#include "sampled/record_spectrum.hpp"

#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;
constexpr int kButterworth = 4;

/// The straight line through the first and the last sample.
struct Line {
  double start = 0.0, slope = 0.0;  ///< slope by the sample
  explicit Line(const Eigen::VectorXd& x) : start(x[0]), slope((x[x.size() - 1] - x[0]) / static_cast<double>(x.size() - 1)) {}
};

}  // namespace

Eigen::VectorXd filtered(const Eigen::VectorXd& x, double sample_time_s, int values_per_sample, Beyond beyond,
                         const std::function<Complex(double)>& response) {
  const Eigen::Index samples = x.size(), length = beyond == Beyond::mirrored ? 2 * samples : 2 * (samples - 1);
  Eigen::VectorXd periodic(length);
  if (beyond == Beyond::mirrored) {
    periodic << x, x.reverse();
  } else {
    const Line line(x);
    for (Eigen::Index n = 0; n < samples; ++n) periodic[n] = x[n] - line.start - line.slope * static_cast<double>(n);
    periodic.tail(samples - 2) = -periodic.segment(1, samples - 2).reverse();
  }
  const Eigen::VectorXcd lines = numerics::half_dft(periodic);
  const Eigen::Index fine = length * values_per_sample;
  Eigen::VectorXcd full = Eigen::VectorXcd::Zero(fine);
  for (Eigen::Index k = 0; 2 * k < length; ++k) {
    const double frequency = static_cast<double>(k) / (static_cast<double>(length) * sample_time_s);
    const Complex value = static_cast<double>(values_per_sample) * lines[k] * response(frequency);
    full[k] = k == 0 ? Complex(value.real()) : value;
    if (k > 0) full[fine - k] = std::conj(value);
  }
  return numerics::inverse_dft(full).real().head(samples * values_per_sample);
}

Eigen::VectorXd interpolated(const Eigen::VectorXd& x, int values_per_sample) {
  const Eigen::Index count = x.size() * values_per_sample;
  const Line line(x);
  // The last sample stands at the end of the turned record: the values behind it belong to its mirror image.
  Eigen::VectorXd fine = filtered(x, 1.0, values_per_sample, Beyond::turned, [](double) { return Complex(1.0); });
  for (Eigen::Index n = 0; n < count; ++n)
    fine[n] += line.start + line.slope * static_cast<double>(n) / static_cast<double>(values_per_sample);
  return fine;
}

Eigen::VectorXd smooth_derivative(const Eigen::VectorXd& x, double sample_time_s, double corner_hz, int order) {
  const double own_corner = corner_hz / std::pow(std::sqrt(2.0) - 1.0, 0.5 / kButterworth);
  const Line line(x);
  Eigen::VectorXd y = filtered(x, sample_time_s, 1, Beyond::turned, [&](double f) {
    const double low_pass = 1.0 / (1.0 + std::pow(f / own_corner, 2 * kButterworth));
    Complex value = low_pass;
    for (int i = 0; i < order; ++i) value *= Complex(0.0, 2.0 * std::numbers::pi * f);
    return value;
  });
  if (order == 1) y.array() += line.slope / sample_time_s;
  if (order == 0)
    for (Eigen::Index n = 0; n < y.size(); ++n) y[n] += line.start + line.slope * static_cast<double>(n);
  return y;
}

}  // namespace bodeflow::residual
