#include "decorrelated_noise.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace bodeflow::koopmans_levin {

namespace {

constexpr Eigen::Index kLeastSamples = 8;  // three directions are taken away
// What is left of a direction that lies in those before is rounding.
constexpr double kNothingLeft = 1e-10;

/// Orthonormal directions.
class Directions {
 public:
  /// The vector without its parts along the directions; twice, for rounding.
  Eigen::VectorXd rest(Eigen::VectorXd v) const {
    for (int pass = 0; pass < 2; ++pass) {
      for (const Eigen::VectorXd& d : all_) v -= d.dot(v) * d;
    }
    return v;
  }
  void add(const Eigen::VectorXd& v) {
    const Eigen::VectorXd left = rest(v);
    if (left.norm() > kNothingLeft * v.norm()) all_.push_back(left.normalized());
  }

 private:
  std::vector<Eigen::VectorXd> all_;
};

}  // namespace

numerics::Expected<NoisePair> decorrelated_noise(const Eigen::Ref<const Eigen::VectorXd>& input,
                                                 const Eigen::Ref<const Eigen::VectorXd>& output, double input_variance,
                                                 double output_variance, numerics::Random& random) {
  const Eigen::Index samples = input.size();
  if (output.size() != samples || samples < kLeastSamples) {
    return numerics::refused("decorrelated noise needs signals of equal length, at least " + std::to_string(kLeastSamples) +
                             " samples; found " + std::to_string(samples) + " and " + std::to_string(output.size()));
  }
  for (const double variance : {input_variance, output_variance}) {
    if (!(variance >= 0.0) || !std::isfinite(variance)) return numerics::refused("a variance must be at least 0 and finite");
  }
  Directions taken;
  taken.add(Eigen::VectorXd::Ones(samples));
  taken.add(input);
  taken.add(output);
  const auto next = [&] {
    Eigen::VectorXd e(samples);
    for (double& value : e) value = random.normal();
    e = taken.rest(e).normalized();
    taken.add(e);
    return e;
  };
  const double length = std::sqrt(static_cast<double>(samples));
  NoisePair noise;
  noise.input = length * std::sqrt(input_variance) * next();
  noise.output = length * std::sqrt(output_variance) * next();
  return noise;
}

}  // namespace bodeflow::koopmans_levin
