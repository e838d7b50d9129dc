#include "residual_tests.hpp"

#include <bodeflow/numerics/chi_squared.hpp>
#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>

namespace bodeflow::validation {
namespace {

/// A sequence with zero mean and unit power; zeros where it is constant.
Eigen::VectorXd normalised(const Eigen::VectorXd& x) {
  const Eigen::VectorXd centred = x.array() - x.mean();
  const double power = centred.squaredNorm() / static_cast<double>(x.size());
  // What is left of a constant after its mean is taken off is rounding.
  const double rounding = std::pow(1e-14 * x.cwiseAbs().maxCoeff(), 2);
  if (!(power > rounding)) return Eigen::VectorXd::Zero(x.size());
  return centred / std::sqrt(power);
}

/// Sum over n of a[n + lag] b[n] / N, lag >= 0.
double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index lag) {
  return a.tail(a.size() - lag).dot(b.head(b.size() - lag)) / static_cast<double>(a.size());
}

/// |X|^2 of the sequence with as many zeros behind it, so that products of spectra are not cyclic.
Eigen::VectorXd padded_power(numerics::RealDft& dft, const Eigen::VectorXd& x) {
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(dft.length());
  padded.head(x.size()) = x;
  Eigen::VectorXcd spectrum(dft.lines());
  dft.forward(padded, spectrum);
  return spectrum.cwiseAbs2();
}

/// Sum over all lags of r_a(k) r_b(k), from their spectra (Parseval).
double correlation_product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index samples = a.size();
  numerics::RealDft dft(2 * samples);
  const Eigen::VectorXd product = padded_power(dft, a).cwiseProduct(padded_power(dft, b));
  const double both_sides = 2.0 * product.sum() - product[0] - product[product.size() - 1];
  return both_sides / static_cast<double>(2 * samples) / std::pow(static_cast<double>(samples), 2);
}

}  // namespace

ResidualTests test_residual(const Eigen::VectorXd& residual, const Eigen::VectorXd& input, Eigen::Index lags, Eigen::Index fitted,
                            double confidence) {
  const Eigen::VectorXd e = normalised(residual), u = normalised(input);
  const auto n = static_cast<double>(e.size());
  const double quantile = numerics::normal_quantile(0.5 + 0.5 * confidence);
  ResidualTests t;
  t.autocorrelation.resize(lags + 1);
  double q = 0.0;
  for (Eigen::Index k = 0; k <= lags; ++k) {
    t.autocorrelation[k] = correlation(e, e, k);
    if (k > 0) q += t.autocorrelation[k] * t.autocorrelation[k] / (n - static_cast<double>(k));
  }
  t.autocorrelation_band = quantile / std::sqrt(n);
  if (lags > fitted) t.whiteness_probability = numerics::chi_squared_tail(n * (n + 2.0) * q, static_cast<double>(lags - fitted));

  t.cross_correlation.resize(2 * lags + 1);
  t.cross_correlation_band = quantile * std::sqrt(std::max(correlation_product(e, u), 0.0) / n);
  for (Eigen::Index k = 0; k <= lags; ++k) {
    t.cross_correlation[lags + k] = correlation(e, u, k);
    t.cross_correlation[lags - k] = correlation(u, e, k);
    if (std::abs(t.cross_correlation[lags + k]) > t.cross_correlation_band) ++t.cross_outside;
  }
  return t;
}

}  // namespace bodeflow::validation
