#include "hand.hpp"

#include <fftw3.h>

#include <algorithm>

namespace bench {

Sums hand_sums(std::span<const double> input, std::span<const double> output, std::size_t periods) {
  const std::size_t size = input.size(), lines = size / 2 + 1;
  double* frame = fftw_alloc_real(size);
  auto* u = reinterpret_cast<std::complex<double>*>(fftw_alloc_complex(lines));
  auto* y = reinterpret_cast<std::complex<double>*>(fftw_alloc_complex(lines));
  const fftw_plan plan = fftw_plan_dft_r2c_1d(static_cast<int>(size), frame, reinterpret_cast<fftw_complex*>(u), FFTW_ESTIMATE);
  Sums sums{std::vector<std::complex<double>>(lines), std::vector<std::complex<double>>(lines),
            std::vector<std::complex<double>>(lines), std::vector<double>(lines), std::vector<double>(lines)};
  for (std::size_t p = 0; p < periods; ++p) {
    std::copy(input.begin(), input.end(), frame);
    fftw_execute_dft_r2c(plan, frame, reinterpret_cast<fftw_complex*>(u));
    std::copy(output.begin(), output.end(), frame);
    fftw_execute_dft_r2c(plan, frame, reinterpret_cast<fftw_complex*>(y));
    for (std::size_t k = 0; k < lines; ++k) {
      sums.input[k] += u[k];
      sums.output[k] += y[k];
      sums.input_power[k] += std::norm(u[k]);
      sums.output_power[k] += std::norm(y[k]);
      sums.cross[k] += std::complex<double>(y[k].real() * u[k].real() + y[k].imag() * u[k].imag(),
                                            y[k].imag() * u[k].real() - y[k].real() * u[k].imag());
    }
  }
  fftw_destroy_plan(plan);
  fftw_free(frame);
  fftw_free(u);
  fftw_free(y);
  return sums;
}

}  // namespace bench
