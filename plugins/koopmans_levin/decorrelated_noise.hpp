#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/random.hpp>

namespace bodeflow::koopmans_levin {

/// Noise on an input and an output.
struct NoisePair {
  Eigen::VectorXd input, output;
};

/// Normal noise that has over the record exactly what white noise has in the mean: zero mean, the variances given (mean
/// square), and no correlation at lag zero with the clean signals or with each other.
///
/// The published spreads of Soverini & Catania's Tables I and II come out with this noise: independent noise makes those of
/// lambda_u and beta_0 1.7 and 2 times as large. Method: Gram-Schmidt against the constant, both signals and the other noise.
/// Errors: signals of different length, fewer than 8 samples, a variance that is negative or not finite.
numerics::Expected<NoisePair> decorrelated_noise(const Eigen::Ref<const Eigen::VectorXd>& input,
                                                 const Eigen::Ref<const Eigen::VectorXd>& output, double input_variance,
                                                 double output_variance, numerics::Random& random);

}  // namespace bodeflow::koopmans_levin
