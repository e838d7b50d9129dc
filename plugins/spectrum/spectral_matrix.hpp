#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/fft.hpp>
#include <complex>
#include <cstdint>
#include <vector>

namespace bodeflow::spectrum {

/// Averages Z Z^H over windows, Z the spectra of all signals: the data of Frisch and total least squares methods.
///
/// Spectra: Z_a(k) = 1/N sum_n z_a[n] exp(-2 pi i k n / N), the first sample of a window taken off before for accuracy. Windows
/// may be shifted against each other by any number of samples: a shift turns all signals by the same phase, which cancels in Z
/// Z^H. It would not cancel in the mean of Z, which turns to zero or, brought back to one phase, makes the matrix one of rank 1.
/// E{Z Z^H} = Z_0 Z_0^H + C, with Z_0 the steady state and C the noise covariance of one window. Overlapping windows are not
/// independent: for white noise a shift of N/2 is worth nearly as many as any smaller one.
///
/// Reference: R. Pintelon, J. Schoukens, System Identification, 2nd ed. 2012, sections 2.2 and 10.2 (periodic and arbitrary
/// data). Cost: O(N log N) a window and signal, and O(N s^2); memory O(N s^2).
class SpectralMatrix {
 public:
  /// period: N >= 3 samples; signals >= 1.
  SpectralMatrix(Eigen::Index period, Eigen::Index signals);

  /// Takes a window: N samples of all signals in columns, all finite.
  void add(const Eigen::Ref<const Eigen::MatrixXd>& frame);
  /// The number of windows taken.
  std::int64_t windows() const { return windows_; }
  /// Mean of Z Z^H at line k, 0 .. N/2: signals x signals, Hermitian, positive semidefinite; rank 1 for one window.
  Eigen::MatrixXcd matrix(Eigen::Index k) const;
  /// Forgets all windows.
  void clear();

 private:
  std::int64_t windows_ = 0;
  std::vector<numerics::RealDft> dft_;                  // one a signal
  std::vector<Eigen::Map<Eigen::VectorXcd>> spectrum_;  // of the newest window
  Eigen::MatrixXcd products_;  // lines x pairs a >= b, in column a (a + 1) / 2 + b: sums of Z_a conj(Z_b)
};

}  // namespace bodeflow::spectrum
