#include "fourier_sum.hpp"

#include <algorithm>

#include "phase.hpp"

namespace bodeflow::generators {
namespace {

using Complex = FourierSum::Complex;

Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

std::vector<Complex> turns(std::size_t count) {
  std::vector<Complex> table(count);
  const double size = static_cast<double>(count);
  for (std::size_t m = 0; m < count; ++m) {
    const double cycles = (2 * m <= count ? static_cast<double>(m) : static_cast<double>(m) - size) / size;
    table[m] = turn_of_cycles(cycles);
  }
  return table;
}

std::size_t next_factor(std::size_t n) {
  if (n % 4 == 0) return 4;
  for (std::size_t p = 2; p * p <= n; ++p) {
    if (n % p == 0) return p;
  }
  return n;
}

}  // namespace

FourierSum::FourierSum(std::size_t size) : turns_(turns(size)) {
  std::size_t largest = 1;
  for (std::size_t left = size; left > 1; left /= next_factor(left)) largest = std::max(largest, next_factor(left));
  group_.resize(largest);
}

void FourierSum::run(std::span<const Complex> lines, std::span<Complex> x) { sum(lines.data(), 1, x.data(), turns_.size()); }

std::int64_t FourierSum::sum_of_factors(std::int64_t size) {
  std::int64_t total = 0;
  for (auto left = static_cast<std::size_t>(size); left > 1; left /= next_factor(left))
    total += static_cast<std::int64_t>(next_factor(left));
  return total;
}

void FourierSum::sum(const Complex* lines, std::size_t stride, Complex* x, std::size_t count) {
  if (count == 1) {
    x[0] = lines[0];
    return;
  }
  const std::size_t radix = next_factor(count);
  const std::size_t part = count / radix;
  for (std::size_t r = 0; r < radix; ++r) sum(lines + r * stride, stride * radix, x + r * part, part);
  if (radix == 4) {
    join_four(x, part, stride);
  } else {
    join(x, part, radix, stride);
  }
}

// The outputs n, n + part, n + 2 part ... from output n of each part, n = 0 .. part-1.
void FourierSum::join_four(Complex* x, std::size_t part, std::size_t stride) const {
  for (std::size_t n = 0; n < part; ++n) {
    const Complex a = x[n];
    const Complex b = product(x[part + n], turns_[n * stride]);
    const Complex c = product(x[2 * part + n], turns_[2 * n * stride]);
    const Complex d = product(x[3 * part + n], turns_[3 * n * stride]);
    const Complex even = a + c, odd = a - c, sum = b + d;
    const Complex turned(d.imag() - b.imag(), b.real() - d.real());  // i (b - d)
    x[n] = even + sum;
    x[part + n] = odd + turned;
    x[2 * part + n] = even - sum;
    x[3 * part + n] = odd - turned;
  }
}

void FourierSum::join(Complex* x, std::size_t part, std::size_t radix, std::size_t stride) {
  const std::size_t step = turns_.size() / radix;
  for (std::size_t n = 0; n < part; ++n) {
    for (std::size_t r = 0; r < radix; ++r) group_[r] = product(x[r * part + n], turns_[r * n * stride]);
    for (std::size_t q = 0; q < radix; ++q) {
      Complex sum = group_[0];
      for (std::size_t r = 1, turn = q; r < radix; ++r, turn = turn + q < radix ? turn + q : turn + q - radix)
        sum += product(group_[r], turns_[turn * step]);
      x[q * part + n] = sum;
    }
  }
}

}  // namespace bodeflow::generators
