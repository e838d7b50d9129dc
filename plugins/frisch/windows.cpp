#include "windows.hpp"

#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace bodeflow::frisch {

namespace {

using Complex = std::complex<double>;

std::string size_of(const Eigen::MatrixXcd& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

Expected<void> check_sizes(const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output, Eigen::Index least_windows) {
  if (input.rows() != output.rows() || input.cols() != output.cols()) {
    return refused("spectra of input and output differ in size: " + size_of(input) + " and " + size_of(output));
  }
  if (input.rows() < 1) return refused("the spectra have no line");
  if (input.cols() < least_windows) {
    return refused("at least " + std::to_string(least_windows) + " windows are needed; found " + std::to_string(input.cols()));
  }
  return {};
}

Expected<void> check_request(const Eigen::Ref<const Eigen::VectorXd>& record, Eigen::Index period, Eigen::Index step,
                             const std::vector<Eigen::Index>& lines) {
  if (period < 1 || step < 1) return refused("period and step must be at least 1 sample");
  if (record.size() < period) {
    return refused("the record has " + std::to_string(record.size()) + " samples, fewer than a period of " +
                   std::to_string(period));
  }
  for (const Eigen::Index k : lines) {
    if (k < 1 || 2 * k >= period) {
      return refused("line " + std::to_string(k) + " is not within 1 .. " + std::to_string((period - 1) / 2));
    }
  }
  for (Eigen::Index t = 0; t < record.size(); ++t) {
    if (!std::isfinite(record[t])) return refused("sample " + std::to_string(t) + " is not a finite number");
  }
  return {};
}

}  // namespace

Expected<Eigen::MatrixXcd> window_spectra(const Eigen::Ref<const Eigen::VectorXd>& record, Eigen::Index period, Eigen::Index step,
                                          const std::vector<Eigen::Index>& lines) {
  if (auto fine = check_request(record, period, step, lines); !fine) return tl::make_unexpected(fine.error());
  const Eigen::Index windows = (record.size() - period) / step + 1;
  Eigen::MatrixXcd spectra(static_cast<Eigen::Index>(lines.size()), windows);
  numerics::RealDft dft(period);
  Eigen::VectorXcd half(dft.lines());
  const double scale = 1.0 / std::sqrt(static_cast<double>(period));
  for (Eigen::Index r = 0; r < windows; ++r) {
    dft.forward(record.segment(r * step, period), half);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto turns = static_cast<double>(lines[i] * r * step % period) / static_cast<double>(period);
      spectra(static_cast<Eigen::Index>(i), r) = std::polar(scale, -2.0 * std::numbers::pi * turns) * half[lines[i]];
    }
  }
  return spectra;
}

Expected<PowerSpectra> power_spectra(const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output) {
  if (auto fine = check_sizes(input, output, 1); !fine) return tl::make_unexpected(fine.error());
  PowerSpectra p;
  p.uu = input.rowwise().squaredNorm() / static_cast<double>(input.cols());
  p.yy = output.rowwise().squaredNorm() / static_cast<double>(input.cols());
  p.yu = output.cwiseProduct(input.conjugate()).rowwise().mean();
  return p;
}

Expected<PooledNoise> pooled_noise(const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output) {
  if (auto fine = check_sizes(input, output, 2); !fine) return tl::make_unexpected(fine.error());
  const Eigen::MatrixXcd u = input.colwise() - input.rowwise().mean().eval();
  const Eigen::MatrixXcd y = output.colwise() - output.rowwise().mean().eval();
  PooledNoise noise;
  noise.degrees_of_freedom = static_cast<double>(input.rows() * (input.cols() - 1));
  noise.input_variance = u.squaredNorm() / noise.degrees_of_freedom;
  noise.output_variance = y.squaredNorm() / noise.degrees_of_freedom;
  noise.covariance = y.cwiseProduct(u.conjugate()).sum() / noise.degrees_of_freedom;
  return noise;
}

Expected<MeanSpectra> mean_spectra(const Eigen::VectorXd& omega, const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output,
                                   const PooledNoise& noise, bool with_covariance) {
  if (auto fine = check_sizes(input, output, 1); !fine) return tl::make_unexpected(fine.error());
  if (omega.size() != input.rows()) {
    return refused(std::to_string(omega.size()) + " frequencies for " + std::to_string(input.rows()) + " lines");
  }
  const Eigen::Index lines = omega.size();
  const double share = 1.0 / static_cast<double>(input.cols());
  MeanSpectra m;
  m.omega = omega;
  m.input = input.rowwise().mean();
  m.output = output.rowwise().mean();
  m.input_variance = Eigen::VectorXd::Constant(lines, noise.input_variance * share);
  m.output_variance = Eigen::VectorXd::Constant(lines, noise.output_variance * share);
  m.covariance = Eigen::VectorXcd::Constant(lines, with_covariance ? noise.covariance * share : Complex(0.0));
  return m;
}

MeanSpectra joined(const MeanSpectra& first, const MeanSpectra& second) {
  const auto stack = [](const auto& a, const auto& b) {
    std::decay_t<decltype(a)> both(a.size() + b.size());
    both << a, b;
    return both;
  };
  return {stack(first.omega, second.omega),
          stack(first.input, second.input),
          stack(first.output, second.output),
          stack(first.input_variance, second.input_variance),
          stack(first.output_variance, second.output_variance),
          stack(first.covariance, second.covariance)};
}

}  // namespace bodeflow::frisch
