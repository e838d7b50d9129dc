#include "bodeflow/numerics/fir_design.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "bodeflow/numerics/fir.hpp"

namespace bodeflow::numerics {
namespace {

using std::numbers::pi;

// Below it the normal equations have lost what tells their solutions apart.
constexpr double kLeastCondition = 1e-13;

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// sin(pi x t) / (pi t), x at t = 0: the ideal low-pass filter with its edge at x.
double sinc(double x, double t) { return t == 0 ? x : std::sin(pi * x * t) / (pi * t); }

// The raised cosines sum_i (-1)^i a_i cos(2 pi i j / (length - 1)).
Eigen::VectorXd cosines(Eigen::Index length, double a0, double a1, double a2) {
  Eigen::VectorXd w(length);
  for (Eigen::Index j = 0; j < length; ++j) {
    const double x =
        length == 1 ? pi : 2 * pi * static_cast<double>(std::min(j, length - 1 - j)) / static_cast<double>(length - 1);
    w[j] = a0 - a1 * std::cos(x) + a2 * std::cos(2 * x);
  }
  return w;
}

std::string wrong_taps(int taps, int most) {
  if (taps >= 1 && taps <= most) return "";
  return std::to_string(taps) + " taps: allowed are 1 to " + std::to_string(most);
}

std::string even_taps(int taps) {
  return std::to_string(taps) +
         " taps: a symmetric filter with an even number of them is 0 at the Nyquist frequency; allowed here: odd";
}

std::string wrong_window_design(const WindowDesign& d) {
  if (std::string wrong = wrong_taps(d.taps, kMostTaps); !wrong.empty()) return wrong;
  if (d.taps % 2 == 0 && (d.pass == Pass::high || d.pass == Pass::stop)) return even_taps(d.taps);
  const bool band = d.pass == Pass::band || d.pass == Pass::stop;
  for (int i = 0; i < (band ? 2 : 1); ++i) {
    const double edge = d.edges[static_cast<std::size_t>(i)];
    if (!(edge > 0 && edge < 1)) return "the edge at " + text_of(edge) + " of the Nyquist frequency: allowed is between 0 and 1";
  }
  if (band && !(d.edges[0] < d.edges[1])) return "the lower edge of the band must lie below the upper one";
  if (d.shape == Window::kaiser && !(d.beta >= 0 && d.beta <= 50)) return "the Kaiser window's beta must be 0 to 50";
  return "";
}

std::string wrong_bands(int taps, const std::vector<Band>& bands) {
  if (std::string wrong = wrong_taps(taps, kMostLeastSquaresTaps); !wrong.empty()) return wrong;
  if (bands.empty()) return "a least-squares filter needs at least one band";
  double before = 0;
  for (const Band& b : bands) {
    const std::string name = "the band " + text_of(b.low) + " to " + text_of(b.high) + " of the Nyquist frequency";
    if (!(b.low >= 0 && b.low < b.high && b.high <= 1)) return name + ": allowed are 0 <= low < high <= 1";
    if (b.low < before) return name + " begins below the end of the one before";
    if (!(b.weight > 0) || !std::isfinite(b.weight)) return name + " has the weight " + text_of(b.weight) + ", allowed: above 0";
    if (!std::isfinite(b.from) || !std::isfinite(b.to)) return name + " has a gain that is not finite";
    if (taps % 2 == 0 && b.high == 1 && b.to != 0) return even_taps(taps);
    before = b.high;
  }
  return "";
}

// int_low^high cos(pi f t) df.
double cosine_integral(const Band& b, double t) { return sinc(b.high, t) - sinc(b.low, t); }

// int_low^high wanted(f) cos(pi f t) df.
double wanted_integral(const Band& b, double t) {
  const double slope = (b.to - b.from) / (b.high - b.low);
  if (t == 0) return 0.5 * (b.from + b.to) * (b.high - b.low);
  const double turn = (std::cos(pi * b.high * t) - std::cos(pi * b.low * t)) / (pi * pi * t * t);
  return b.to * sinc(b.high, t) - b.from * sinc(b.low, t) + slope * turn;
}

// The solution of Q a = b, Q positive semidefinite; that of least norm where double precision does not determine it.
Eigen::VectorXd solve(const Eigen::MatrixXd& Q, const Eigen::VectorXd& b) {
  const Eigen::LDLT<Eigen::MatrixXd> factors(Q);
  if (factors.isPositive() && factors.rcond() > kLeastCondition) return factors.solve(b);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Q);
  const Eigen::VectorXd& lambda = eigen.eigenvalues();
  const double least = kLeastCondition * lambda.maxCoeff();
  Eigen::VectorXd part = eigen.eigenvectors().transpose() * b;
  for (Eigen::Index i = 0; i < part.size(); ++i) part[i] = lambda[i] > least ? part[i] / lambda[i] : 0.0;
  return eigen.eigenvectors() * part;
}

}  // namespace

Eigen::VectorXd window(Window kind, Eigen::Index length, double beta) {
  switch (kind) {
    case Window::rectangular:
      return Eigen::VectorXd::Ones(length);
    case Window::hann:
      return cosines(length, 0.5, 0.5, 0.0);
    case Window::hamming:
      return cosines(length, 0.54, 0.46, 0.0);
    case Window::blackman:
      return cosines(length, 0.42, 0.5, 0.08);
    case Window::kaiser:
      return kaiser_window(length, beta);
  }
  return Eigen::VectorXd::Ones(length);
}

Expected<Eigen::VectorXd> fir_by_window(const WindowDesign& d) {
  if (std::string wrong = wrong_window_design(d); !wrong.empty()) return refused(std::move(wrong));
  Eigen::VectorXd h = window(d.shape, d.taps, d.beta);
  const double middle = 0.5 * (d.taps - 1);
  for (Eigen::Index j = 0; j < h.size(); ++j) {
    const double t = std::abs(static_cast<double>(j) - middle);
    const double low = sinc(d.edges[0], t), high = sinc(d.edges[1], t), all = sinc(1.0, t);
    h[j] *= d.pass == Pass::low ? low : d.pass == Pass::high ? all - low : d.pass == Pass::band ? high - low : all - high + low;
  }
  double at = 0;
  if (d.pass == Pass::high) at = 1;
  if (d.pass == Pass::band) at = 0.5 * (d.edges[0] + d.edges[1]);
  double gain = 0;
  for (Eigen::Index j = 0; j < h.size(); ++j) gain += h[j] * std::cos(pi * at * (static_cast<double>(j) - middle));
  return Eigen::VectorXd(h / gain);
}

Expected<Eigen::VectorXd> fir_by_least_squares(int taps, const std::vector<Band>& bands) {
  if (std::string wrong = wrong_bands(taps, bands); !wrong.empty()) return refused(std::move(wrong));
  // H(f) = exp(-j pi f (taps - 1) / 2) sum_n a_n cos(pi f t_n), t_n = n or n + 1/2.
  const Eigen::Index count = (taps + 1) / 2;
  const double shift = taps % 2 == 0 ? 0.5 : 0.0;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(2 * count), difference = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(count);
  for (const Band& band : bands) {
    for (Eigen::Index n = 0; n < 2 * count; ++n)
      sum[n] += band.weight * cosine_integral(band, static_cast<double>(n) + 2 * shift);
    for (Eigen::Index n = 0; n < count; ++n) {
      difference[n] += band.weight * cosine_integral(band, static_cast<double>(n));
      b[n] += band.weight * wanted_integral(band, static_cast<double>(n) + shift);
    }
  }
  Eigen::MatrixXd Q(count, count);
  for (Eigen::Index m = 0; m < count; ++m) {
    for (Eigen::Index n = 0; n < count; ++n) Q(m, n) = 0.5 * (difference[std::abs(m - n)] + sum[m + n]);
  }
  const Eigen::VectorXd a = solve(Q, b);
  Eigen::VectorXd h(taps);
  for (Eigen::Index n = 0; n < count; ++n) {
    const double half = n == 0 && shift == 0 ? a[n] : 0.5 * a[n];
    h[taps / 2 + n] = half;
    h[(taps - 1) / 2 - n] = half;
  }
  return h;
}

}  // namespace bodeflow::numerics
