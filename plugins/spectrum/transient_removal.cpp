#include "transient_removal.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <complex>
#include <string>

namespace bodeflow::spectrum {
namespace {

constexpr Eigen::Index kParameters = 4;

/// The bins nearest to `center` that are no multiples of the number of periods; below zero and above the Nyquist frequency too.
std::vector<Eigen::Index> bins_beside(Eigen::Index center, Eigen::Index periods) {
  std::vector<Eigen::Index> bins;
  for (Eigen::Index r = 1; static_cast<Eigen::Index>(bins.size()) < TransientRemoval::kBins; ++r) {
    if (r % periods == 0) continue;
    bins.push_back(center - r);
    bins.push_back(center + r);
  }
  return bins;
}

/// Bin b of the spectrum of `length` real samples, of which `half` has those up to the Nyquist frequency: Z(-b) = conj Z(b).
std::complex<double> at_bin(const Eigen::VectorXcd& half, Eigen::Index length, Eigen::Index b) {
  const Eigen::Index round = (b % length + length) % length;
  return round < half.size() ? half[round] : std::conj(half[length - round]);
}

struct Fit {
  std::complex<double> transient;
  double leverage = 0.0;       // variance of `transient` per variance of a bin
  Eigen::VectorXcd residuals;  // of the bins
};

Fit fit_transient(const Eigen::VectorXcd& spectrum, Eigen::Index length, const std::vector<Eigen::Index>& bins,
                  Eigen::Index center) {
  const auto count = static_cast<Eigen::Index>(bins.size());
  Eigen::MatrixXcd model(count, kParameters);
  Eigen::VectorXcd z(count);
  const auto reach = static_cast<double>(std::abs(bins.back() - center));
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index b = bins[static_cast<std::size_t>(i)];
    const double r = static_cast<double>(b - center) / reach;
    z[i] = at_bin(spectrum, length, b);
    model.row(i) << 1.0, r, r * r, -r * z[i];
  }
  const double size = z.norm();
  Fit fit;
  fit.residuals = Eigen::VectorXcd::Zero(count);
  if (!(size > 0.0)) return fit;
  model.col(kParameters - 1) /= size;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(model);
  const Eigen::VectorXcd b = qr.solve(z);
  fit.transient = b[0];
  fit.residuals = z - model * b;
  const Eigen::VectorXcd weights = qr.solve(Eigen::MatrixXcd::Identity(count, count)).row(0);
  fit.leverage = weights.squaredNorm();
  return fit;
}

}  // namespace

void TransientRemoval::add(const Eigen::Ref<const Eigen::MatrixXd>& frame) {
  if ((periods() + 1) * period_ * frame.cols() > kMostValues) {
    fail("removing the transient keeps the whole record in memory: at most " +
         std::to_string(kMostValues / (period_ * frame.cols())) + " periods of " + std::to_string(period_) + " samples and " +
         std::to_string(frame.cols()) + " channels; skip the transient instead, or measure fewer");
  }
  for (Eigen::Index a = 0; a < frame.cols(); ++a) {
    auto& to = samples_[static_cast<std::size_t>(a)];
    to.insert(to.end(), frame.col(a).begin(), frame.col(a).end());
  }
}

void TransientRemoval::clear() {
  for (auto& s : samples_) s.clear();
}

Expected<Moments> TransientRemoval::moments() const {
  const auto periods = static_cast<Eigen::Index>(this->periods());
  if (periods < 2) {
    return unexpected("the transient is told from the steady state by at least 2 periods; found " + std::to_string(periods));
  }
  const Eigen::Index length = periods * period_, signals = layout_.signals();
  if (length - period_ < 2 * kBins) {
    return unexpected("a period of " + std::to_string(period_) + " samples is too short to remove the transient");
  }
  numerics::RealDft dft(length);
  std::vector<Eigen::VectorXcd> spectra;
  for (const auto& samples : samples_) {
    dft.samples() = Eigen::Map<const Eigen::VectorXd>(samples.data(), length).array() - samples.front();
    spectra.push_back(dft.transform() / static_cast<double>(length));
    spectra.back()[0] += samples.front();
  }
  Moments m;
  m.periods = periods;
  m.degrees_of_freedom = static_cast<double>(kBins - kParameters);
  const Eigen::Index lines = period_ / 2 + 1;
  m.mean.resize(lines, signals);
  m.variance = Eigen::MatrixXd::Zero(lines, signals);
  m.covariance = Eigen::MatrixXcd::Zero(lines, signals * (signals - 1) / 2);
  for (Eigen::Index k = 0; k < lines; ++k) {
    for (Eigen::Index a = 0; a < signals; ++a) m.mean(k, a) = spectra[static_cast<std::size_t>(a)][k * periods];
    if (k == 0 || 2 * k == period_) continue;
    const std::vector<Eigen::Index> bins = bins_beside(k * periods, periods);
    const auto degrees = static_cast<double>(static_cast<Eigen::Index>(bins.size()) - kParameters);
    std::vector<Fit> fits;
    for (Eigen::Index a = 0; a < signals; ++a) {
      Fit& fit = fits.emplace_back(fit_transient(spectra[static_cast<std::size_t>(a)], length, bins, k * periods));
      m.mean(k, a) -= fit.transient;
      fit.residuals *= std::sqrt((1.0 + fit.leverage) / degrees);
      m.variance(k, a) = fit.residuals.squaredNorm();
      for (Eigen::Index b = 0; b < a; ++b) {
        m.covariance(k, pair_column(a, b)) = fits[static_cast<std::size_t>(b)].residuals.dot(fit.residuals);
      }
    }
  }
  return m;
}

}  // namespace bodeflow::spectrum
