#include "bodeflow/numerics/fft.hpp"

namespace bodeflow::numerics {

Eigen::VectorXcd half_dft(const Eigen::Ref<const Eigen::VectorXd>& x) {
  if (x.size() == 0) return {};
  RealDft transform(x.size());
  Eigen::VectorXcd spectrum(transform.lines());
  transform.forward(x, spectrum);
  return spectrum;
}

Eigen::VectorXcd dft(const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::VectorXcd half = half_dft(x);
  Eigen::VectorXcd spectrum(x.size());
  spectrum.head(half.size()) = half;
  for (Eigen::Index k = half.size(); k < x.size(); ++k) spectrum[k] = std::conj(half[x.size() - k]);
  return spectrum;
}

Eigen::VectorXcd dft(const Eigen::Ref<const Eigen::VectorXcd>& x) {
  Eigen::VectorXcd spectrum(x.size());
  if (x.size() > 0) ComplexDft(x.size()).forward(x, spectrum);
  return spectrum;
}

Eigen::VectorXcd inverse_dft(const Eigen::Ref<const Eigen::VectorXcd>& spectrum) {
  Eigen::VectorXcd x(spectrum.size());
  if (x.size() > 0) ComplexDft(x.size()).inverse(spectrum, x);
  return x;
}

}  // namespace bodeflow::numerics
