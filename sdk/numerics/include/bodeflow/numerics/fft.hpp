#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>

namespace bodeflow::numerics {

/// Discrete Fourier transform of real sequences of one length N >= 1 (any N; products of small primes are fastest).
///
/// Method: FFTW 3 with FFTW_ESTIMATE and no wisdom, so that the same input gives the same bits in every run; where FFTW is
/// absent, Eigen's FFT (kissfft). Cost: O(N log N). Threads: making and destroying is safe on any thread, one object must
/// not run on two threads at once. Nothing is allocated by `forward` with FFTW.
class RealDft {
 public:
  explicit RealDft(Eigen::Index length);
  ~RealDft();
  RealDft(RealDft&&) noexcept;
  RealDft& operator=(RealDft&&) noexcept;

  /// N, the number of samples.
  Eigen::Index length() const;
  /// The number of lines of the half spectrum: floor(N/2) + 1, from zero frequency up to the Nyquist line.
  Eigen::Index lines() const { return length() / 2 + 1; }

  /// Half spectrum X[k] = sum_n x[n] exp(-2 pi i k n / N), k = 0 .. floor(N/2), not scaled.
  /// x: `length()` samples; spectrum: `lines()` values, overwritten.
  void forward(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXcd> spectrum);

  /// The place of the samples that `transform` takes, `length()` values to be written: spares the copies of `forward`.
  Eigen::Map<Eigen::VectorXd> samples();
  /// The half spectrum, as in `forward`, of what was written to `samples`: `lines()` values that the caller may change, valid
  /// until the next transform. The samples have to be written anew before it.
  Eigen::Map<Eigen::VectorXcd> transform();

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// Discrete Fourier transform of complex sequences of one length N >= 1; method, cost and threads as in RealDft.
class ComplexDft {
 public:
  explicit ComplexDft(Eigen::Index length);
  ~ComplexDft();
  ComplexDft(ComplexDft&&) noexcept;
  ComplexDft& operator=(ComplexDft&&) noexcept;

  /// N, the number of samples and of lines.
  Eigen::Index length() const;

  /// X[k] = sum_n x[n] exp(-2 pi i k n / N), k = 0 .. N-1, not scaled. Both arguments have `length()` values and may be the same.
  void forward(const Eigen::Ref<const Eigen::VectorXcd>& x, Eigen::Ref<Eigen::VectorXcd> spectrum);

  /// x[n] = 1/N sum_k X[k] exp(+2 pi i k n / N), the inverse of `forward`.
  void inverse(const Eigen::Ref<const Eigen::VectorXcd>& spectrum, Eigen::Ref<Eigen::VectorXcd> x);

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// The full spectrum of a real sequence: N lines, X[N-k] = conj(X[k]). Empty for an empty sequence. Plans at every call:
/// keep a RealDft where the same length comes again.
Eigen::VectorXcd dft(const Eigen::Ref<const Eigen::VectorXd>& x);

/// The full spectrum of a complex sequence: N lines.
Eigen::VectorXcd dft(const Eigen::Ref<const Eigen::VectorXcd>& x);

/// The half spectrum of a real sequence: floor(N/2) + 1 lines. Empty for an empty sequence.
Eigen::VectorXcd half_dft(const Eigen::Ref<const Eigen::VectorXd>& x);

/// The sequence of which `spectrum` is the full spectrum (scaled by 1/N).
Eigen::VectorXcd inverse_dft(const Eigen::Ref<const Eigen::VectorXcd>& spectrum);

/// The library that computes: "fftw" or "kissfft".
const char* fft_library();

}  // namespace bodeflow::numerics
