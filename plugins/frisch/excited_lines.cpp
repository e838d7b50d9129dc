#include "excited_lines.hpp"

#include <bodeflow/numerics/fft.hpp>
#include <string>

namespace bodeflow::frisch {

Expected<std::vector<Eigen::Index>> excited_lines(const Eigen::VectorXd& signal, Eigen::Index period, double threshold) {
  if (period < 3 || signal.size() < period) {
    return refused(std::to_string(signal.size()) + " samples; needed: at least one period of " + std::to_string(period));
  }
  const Eigen::Index periods = signal.size() / period;
  const Eigen::VectorXd mean = signal.head(periods * period).reshaped(period, periods).rowwise().mean();
  const Eigen::VectorXd size = numerics::half_dft(mean).cwiseAbs();
  const Eigen::Index last = (period - 1) / 2;
  const double least = threshold * size.segment(1, last).maxCoeff();
  if (!(least > 0.0)) return refused("the signal is constant: it excites no line");
  std::vector<Eigen::Index> lines;
  for (Eigen::Index k = 1; k <= last; ++k) {
    if (size[k] >= least) lines.push_back(k);
  }
  return lines;
}

}  // namespace bodeflow::frisch
