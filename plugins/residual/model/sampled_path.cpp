#include "model/sampled_path.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// Aliases on each side that are added one by one.
constexpr int kAliases = 3;

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

Eigen::RowVectorXcd SampledPath::at(double frequency_hz) const {
  const Complex s(0.0, 2.0 * std::numbers::pi * frequency_hz);
  if (exact_ && path_.bare()) return exact_->at(frequency_hz);
  if (hold_ == Hold::band_limited || frequency_hz == 0.0) {
    path_.responses(s, plain_, joint_);
    return joint_ * std::exp(-s * delay_s_);
  }
  // The hold at the aliases of f has one numerator, over f + k / T or its square; a delay turns them by equal angles.
  const double rate = 1.0 / sample_time_s_, angle = std::numbers::pi * frequency_hz * sample_time_s_, sine = std::sin(angle);
  const bool straight = hold_ == Hold::first_order;
  const Complex numerator = (straight ? Complex(sine * sine) : std::polar(sine, -angle)) * std::exp(-s * delay_s_);
  const Complex turn = std::polar(1.0, -2.0 * std::numbers::pi * delay_s_ * rate);
  Complex turned = std::conj(turn) * std::conj(turn) * std::conj(turn);
  static_assert(kAliases == 3);
  const Eigen::Index q = path_.inputs();
  Eigen::RowVectorXcd joint = Eigen::RowVectorXcd::Zero(q), plain = joint, outer_joint = joint, outer_plain = joint;
  for (int k = -kAliases; k <= kAliases; ++k, turned = times(turned, turn)) {
    const double x = std::numbers::pi * (frequency_hz + k * rate) * sample_time_s_;
    const Complex factor = times(numerator, turned) * (1.0 / (straight ? x * x : x));
    path_.responses({0.0, 2.0 * std::numbers::pi * (frequency_hz + k * rate)}, plain_, joint_);
    for (Eigen::Index j = 0; j < q; ++j) {
      const Complex a = times(factor, joint_[j]), b = times(factor, plain_[j]);
      joint[j] += a;
      plain[j] += b;
      if (std::abs(k) < kAliases) continue;
      outer_joint[j] += a;
      outer_plain[j] += b;
    }
  }
  if (!exact_) return joint;
  const Eigen::RowVectorXcd rest = exact_->at(frequency_hz) - plain;
  for (Eigen::Index j = 0; j < q; ++j)
    if (outer_plain[j] != Complex(0.0)) joint[j] += rest[j] * outer_joint[j] / outer_plain[j];
  return joint;
}

}  // namespace bodeflow::residual
