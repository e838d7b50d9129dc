#include "spectral_matrix.hpp"

namespace bodeflow::spectrum {
namespace {

Eigen::Index column(Eigen::Index a, Eigen::Index b) { return a * (a + 1) / 2 + b; }

}  // namespace

SpectralMatrix::SpectralMatrix(Eigen::Index period, Eigen::Index signals) {
  dft_.reserve(static_cast<std::size_t>(signals));
  for (Eigen::Index a = 0; a < signals; ++a) {
    dft_.emplace_back(period);
    dft_.back().samples().setZero();
    spectrum_.push_back(dft_.back().transform());
  }
  products_.resize(period / 2 + 1, signals * (signals + 1) / 2);
  clear();
}

void SpectralMatrix::clear() {
  windows_ = 0;
  products_.setZero();
}

void SpectralMatrix::add(const Eigen::Ref<const Eigen::MatrixXd>& frame) {
  const auto samples = static_cast<double>(frame.rows());
  for (Eigen::Index a = 0; a < frame.cols(); ++a) {
    auto& dft = dft_[static_cast<std::size_t>(a)];
    const double offset = frame(0, a);
    dft.samples() = frame.col(a).array() - offset;
    auto z = dft.transform();
    z /= samples;
    z[0] += offset;
    for (Eigen::Index b = 0; b <= a; ++b) {
      products_.col(column(a, b)) += z.cwiseProduct(spectrum_[static_cast<std::size_t>(b)].conjugate());
    }
  }
  ++windows_;
}

Eigen::MatrixXcd SpectralMatrix::matrix(Eigen::Index k) const {
  const auto signals = static_cast<Eigen::Index>(dft_.size());
  Eigen::MatrixXcd m(signals, signals);
  for (Eigen::Index a = 0; a < signals; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      m(a, b) = products_(k, column(a, b)) / static_cast<double>(windows_);
      m(b, a) = std::conj(m(a, b));
    }
    m(a, a) = m(a, a).real();
  }
  return m;
}

}  // namespace bodeflow::spectrum
