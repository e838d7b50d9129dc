#include "low_pass.hpp"

#include <cmath>
#include <complex>
#include <cstdio>

namespace {

int failures = 0;

void expect_near(const char* what, double found, double expected, double tolerance) {
  if (std::abs(found - expected) <= tolerance) return;
  std::printf("%s: found %.17g, expected %.17g\n", what, found, expected);
  ++failures;
}

constexpr double kPi = 3.14159265358979323846;

// The step response passes through the samples of 1 - exp(-t / T): the discretisation is exact.
void step_response_is_exact() {
  LowPass filter(10.0, 1000.0);
  for (int n = 1; n <= 200; ++n)
    expect_near("step response", filter.step(1.0), 1.0 - std::exp(-2.0 * kPi * 10.0 * n / 1000.0), 1e-14);
}

// A long sine has the gain and phase of a / (1 - (1 - a) z^-1).
void sine_response_is_that_of_the_transfer_function() {
  const double rate_hz = 1000.0, frequency_hz = 50.0, a = 1.0 - std::exp(-2.0 * kPi * 10.0 / rate_hz);
  const std::complex<double> z = std::polar(1.0, 2.0 * kPi * frequency_hz / rate_hz), g = a / (1.0 - (1.0 - a) / z);
  LowPass filter(10.0, rate_hz);
  for (int n = 0; n < 2000; ++n) {
    const double phase = 2.0 * kPi * frequency_hz * n / rate_hz, y = filter.step(std::sin(phase));
    if (n > 1900) expect_near("sine response", y, std::abs(g) * std::sin(phase + std::arg(g)), 1e-12);
  }
}

}  // namespace

int main() {
  step_response_is_exact();
  sine_response_is_that_of_the_transfer_function();
  return failures == 0 ? 0 : 1;
}
