#include "model/sampled_path.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// Aliases on each side that are added one by one.
constexpr int kAliases = 3;

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

}  // namespace

SampledPath::SampledPath(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                         double sample_time_s)
    : path_(model, values, known),
      hold_(model.base->timing().hold),
      sample_time_s_(sample_time_s),
      delay_s_(model.delay_s(values)) {
  if (hold_ != Hold::band_limited && path_.matrices())
    exact_.emplace(*path_.matrices(), path_.modes(), hold_ == Hold::first_order, sample_time_s, delay_s_);
}

Complex SampledPath::hold(double frequency_hz) const {
  const double half = std::numbers::pi * frequency_hz * sample_time_s_;
  return hold_ == Hold::zero_order ? std::polar(1.0, -half) * sinc(half) : Complex(sinc(half) * sinc(half));
}

Eigen::RowVectorXcd SampledPath::at(double frequency_hz) const {
  const auto s_of = [](double f) { return Complex(0.0, 2.0 * std::numbers::pi * f); };
  if (exact_ && path_.bare()) return exact_->at(frequency_hz);
  if (hold_ == Hold::band_limited || frequency_hz == 0.0) {
    const Complex s = s_of(frequency_hz);
    path_.plant(s, g_);
    return path_.undelayed(s, g_) * std::exp(-s * delay_s_);
  }
  const Eigen::Index q = path_.inputs();
  Eigen::RowVectorXcd joint = Eigen::RowVectorXcd::Zero(q), plain = joint, outer_joint = joint, outer_plain = joint;
  for (int k = -kAliases; k <= kAliases; ++k) {
    const double f = frequency_hz + k / sample_time_s_;
    const Complex s = s_of(f), factor = hold(f) * std::exp(-s * delay_s_);
    path_.plant(s, g_);
    const Eigen::RowVectorXcd a = factor * path_.undelayed(s, g_), b = factor * g_.row(0).head(q);
    joint += a;
    plain += b;
    if (std::abs(k) < kAliases) continue;
    outer_joint += a;
    outer_plain += b;
  }
  if (!exact_) return joint;
  const Eigen::RowVectorXcd rest = exact_->at(frequency_hz) - plain;
  for (Eigen::Index j = 0; j < q; ++j)
    if (outer_plain[j] != Complex(0.0)) joint[j] += rest[j] * outer_joint[j] / outer_plain[j];
  return joint;
}

}  // namespace bodeflow::residual
