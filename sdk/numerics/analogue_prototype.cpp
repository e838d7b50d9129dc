#include "bodeflow/numerics/analogue_prototype.hpp"

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

double power_of(double db) { return std::expm1(db * std::numbers::ln10 / 10); }

Complex product_of_negatives(const Eigen::VectorXcd& roots) {
  Complex product = 1;
  for (const Complex root : roots) product *= -root;
  return product;
}

// With |H(0)| = at_zero. Roots as given: conjugates follow each other.
ZeroPoleGain normalised(const std::vector<Complex>& zeros, const std::vector<Complex>& poles, double at_zero) {
  ZeroPoleGain h;
  h.zeros = Eigen::Map<const Eigen::VectorXcd>(zeros.data(), static_cast<Eigen::Index>(zeros.size()));
  h.poles = Eigen::Map<const Eigen::VectorXcd>(poles.data(), static_cast<Eigen::Index>(poles.size()));
  h.gain = at_zero * (product_of_negatives(h.poles) / product_of_negatives(h.zeros)).real();
  return h;
}

void add_pair(std::vector<Complex>& roots, Complex root) {
  roots.push_back(root);
  roots.push_back(std::conj(root));
}

// Poles on the ellipse -sinh mu sin theta + j cosh mu cos theta, theta = (2 i - 1) pi / (2 n).
std::vector<Complex> chebyshev_poles(int n, double mu) {
  std::vector<Complex> poles;
  for (int i = 1; i <= n / 2; ++i) {
    const double theta = (2 * i - 1) * pi / (2 * n);
    add_pair(poles, {-std::sinh(mu) * std::sin(theta), std::cosh(mu) * std::cos(theta)});
  }
  if (n % 2 == 1) poles.push_back(-std::sinh(mu));
  return poles;
}

ZeroPoleGain butterworth(int n) {
  std::vector<Complex> poles;
  for (int i = 1; i <= n / 2; ++i) add_pair(poles, std::polar(1.0, pi / 2 + (2 * i - 1) * pi / (2 * n)));
  if (n % 2 == 1) poles.push_back(-1.0);
  return normalised({}, poles, 1.0);
}

ZeroPoleGain chebyshev_1(int n, double ripple_db) {
  const double epsilon2 = power_of(ripple_db);
  return normalised({}, chebyshev_poles(n, std::asinh(1 / std::sqrt(epsilon2)) / n),
                    n % 2 == 1 ? 1.0 : 1 / std::sqrt(1 + epsilon2));
}

ZeroPoleGain chebyshev_2(int n, double attenuation_db) {
  std::vector<Complex> zeros, poles;
  for (int i = 1; i <= n / 2; ++i) add_pair(zeros, {0.0, 1 / std::cos((2 * i - 1) * pi / (2 * n))});
  for (const Complex p : chebyshev_poles(n, std::asinh(std::sqrt(power_of(attenuation_db))) / n)) poles.push_back(1.0 / p);
  return normalised(zeros, poles, 1.0);
}

// theta_n in rising powers, from theta_n = (2 n - 1) theta_{n-1} + s^2 theta_{n-2}; whole numbers that a long double holds.
std::vector<long double> bessel_polynomial(int n) {
  std::vector<long double> before{1}, now{1, 1};
  for (int k = 2; k <= n; ++k) {
    std::vector<long double> next(static_cast<std::size_t>(k) + 1, 0);
    for (std::size_t i = 0; i < now.size(); ++i) next[i] += static_cast<long double>(2 * k - 1) * now[i];
    for (std::size_t i = 0; i < before.size(); ++i) next[i + 2] += before[i];
    before = std::move(now);
    now = std::move(next);
  }
  return now;
}

Complex polished(const std::vector<long double>& rising, Complex start) {
  std::complex<long double> s(start);
  for (int step = 0; step < 8; ++step) {
    std::complex<long double> value = 0, slope = 0;
    for (auto c = rising.rbegin(); c != rising.rend(); ++c) {
      slope = slope * s + value;
      value = value * s + *c;
    }
    s -= value / slope;
  }
  return {static_cast<double>(s.real()), static_cast<double>(s.imag())};
}

Expected<std::vector<Complex>> bessel_poles(int n) {
  const std::vector<long double> rising = bessel_polynomial(n);
  Eigen::VectorXd falling(n + 1);
  for (int i = 0; i <= n; ++i) falling[i] = static_cast<double>(rising[static_cast<std::size_t>(n - i)]);
  const auto rough = roots(falling);
  if (!rough) return tl::make_unexpected(rough.error());
  const auto split = split_roots(*rough);
  if (!split) return tl::make_unexpected(split.error());
  std::vector<Complex> poles;
  for (const Complex p : split->pairs) add_pair(poles, polished(rising, p));
  for (const double p : split->real) poles.push_back(polished(rising, p).real());
  return poles;
}

// The frequency at which a low-pass filter that falls all the way has |H|^2 = 1/2.
double half_power_frequency(const ZeroPoleGain& h) {
  const auto power = [&](double w) {
    Complex value = h.gain;
    for (const Complex p : h.poles) value /= Complex(0, w) - p;
    return std::norm(value);
  };
  double low = 0, high = 1;
  while (power(high) > 0.5) high *= 2;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) return middle;
    (power(middle) > 0.5 ? low : high) = middle;
  }
}

Expected<ZeroPoleGain> bessel(int n, bool half_power) {
  auto poles = bessel_poles(n);
  if (!poles) return tl::make_unexpected(poles.error());
  double size = 1;
  for (const Complex p : *poles) size *= std::abs(p);
  for (Complex& p : *poles) p /= std::pow(size, 1.0 / n);
  if (half_power) {
    const double edge = half_power_frequency(normalised({}, *poles, 1.0));
    for (Complex& p : *poles) p /= edge;
  }
  return normalised({}, *poles, 1.0);
}

double mean(double a, double b) {
  while (std::abs(a - b) > 1e-16 * a) {
    const double next = 0.5 * (a + b);
    if (next == a || next == b) break;
    b = std::sqrt(a * b);
    a = next;
  }
  return a;
}

// Jacobi's functions and quarter periods of the modulus that makes an elliptic filter of order n possible: k and its complement
// from the nome q, K(k_1') / K(k_1) = n K(k') / K(k).
struct Modulus {
  double k = 0.0, complement = 0.0, quarter = 0.0;

  Modulus(int n, double k1) {
    const double complement1 = std::sqrt((1 - k1) * (1 + k1));
    // K(k_1') / K(k_1) of means: K(k) = pi / (2 M(1, k')).
    const double q = std::exp(-pi * mean(1, complement1) / (mean(1, k1) * n));
    double two = 0, three = 1, four = 1;
    for (int m = 0; m < 60; ++m) {
      two += std::pow(q, m * (m + 1));
      const double square = 2 * std::pow(q, (m + 1) * (m + 1));
      three += square;
      four += m % 2 == 0 ? -square : square;
    }
    k = 4 * std::sqrt(q) * (two / three) * (two / three);
    complement = (four / three) * (four / three);
    quarter = pi / (2 * mean(1, complement));
  }

  // cd(x + j y, k).
  Complex cd(double x, double y) const {
    double c, d, c1, d1;
    const double s = boost::math::jacobi_elliptic(k, x, &c, &d);
    const double s1 = boost::math::jacobi_elliptic(complement, y, &c1, &d1);
    return Complex(c * c1, -s * d * s1 * d1) / Complex(d * c1 * d1, -k * k * s * c * s1);
  }
};

ZeroPoleGain elliptic(int n, double ripple_db, double attenuation_db) {
  const double epsilon2 = power_of(ripple_db);
  const double k1 = std::sqrt(epsilon2 / power_of(attenuation_db));
  const double at_zero = n % 2 == 1 ? 1.0 : 1 / std::sqrt(1 + epsilon2);
  const double complement1 = std::sqrt((1 - k1) * (1 + k1));
  // y K_1 n = F(atan(1 / epsilon), k_1'): where the poles lie off the axis.
  const double K1 = pi / (2 * mean(1, complement1));
  const double y = boost::math::ellint_1(complement1, std::atan(1 / std::sqrt(epsilon2))) / (n * K1);
  const Modulus modulus(n, k1);
  std::vector<Complex> zeros, poles;
  for (int i = 1; i <= n / 2; ++i) {
    const double u = modulus.quarter * (2 * i - 1) / n;
    add_pair(zeros, {0.0, 1 / (modulus.k * modulus.cd(u, 0).real())});
    const Complex p = Complex(0, 1) * modulus.cd(u, -y * modulus.quarter);
    add_pair(poles, {-std::abs(p.real()), p.imag()});
  }
  if (n % 2 == 1) {
    double c, d;
    const double s = boost::math::jacobi_elliptic(modulus.complement, y * modulus.quarter, &c, &d);
    poles.push_back(-s / c);
  }
  return normalised(zeros, poles, at_zero);
}

std::string checked(FilterKind kind, int order, double ripple_db, double attenuation_db) {
  const bool ripples = kind == FilterKind::chebyshev_1 || kind == FilterKind::elliptic;
  const bool stops = kind == FilterKind::chebyshev_2 || kind == FilterKind::elliptic;
  if (order < 1 || order > kMostFilterOrder) {
    return "order " + std::to_string(order) + ": allowed are 1 to " + std::to_string(kMostFilterOrder);
  }
  if (ripples && !(ripple_db >= 1e-4 && ripple_db <= 20)) return "the ripple must be 0.0001 to 20 dB";
  if (stops && !(attenuation_db >= 5 && attenuation_db <= 200)) return "the attenuation must be 5 to 200 dB";
  if (ripples && stops && !(attenuation_db > ripple_db)) return "the attenuation must be larger than the ripple";
  return "";
}

}  // namespace

Expected<ZeroPoleGain> analogue_prototype(FilterKind kind, int order, double ripple_db, double attenuation_db) {
  if (std::string wrong = checked(kind, order, ripple_db, attenuation_db); !wrong.empty()) return refused(std::move(wrong));
  switch (kind) {
    case FilterKind::butterworth:
      return butterworth(order);
    case FilterKind::chebyshev_1:
      return chebyshev_1(order, ripple_db);
    case FilterKind::chebyshev_2:
      return chebyshev_2(order, attenuation_db);
    case FilterKind::bessel:
      return bessel(order, true);
    case FilterKind::elliptic:
      return elliptic(order, ripple_db, attenuation_db);
  }
  return refused("unknown kind of filter");
}

Expected<ZeroPoleGain> bessel_of_unit_product(int order) {
  if (std::string wrong = checked(FilterKind::bessel, order, 0, 0); !wrong.empty()) return refused(std::move(wrong));
  return bessel(order, false);
}

}  // namespace bodeflow::numerics
