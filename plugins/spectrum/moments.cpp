#include "moments.hpp"

namespace bodeflow::spectrum {

Eigen::MatrixXcd covariance_at(const Moments& moments, Eigen::Index line) {
  const Eigen::Index signals = moments.mean.cols();
  Eigen::MatrixXcd c(signals, signals);
  for (Eigen::Index a = 0; a < signals; ++a) {
    c(a, a) = moments.variance(line, a);
    for (Eigen::Index b = 0; b < a; ++b) {
      c(a, b) = moments.covariance(line, pair_column(a, b));
      c(b, a) = std::conj(c(a, b));
    }
  }
  return c;
}

}  // namespace bodeflow::spectrum
