#include "line_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace bodeflow::koopmans_levin {

namespace {

using Array = Eigen::ArrayXd;

constexpr Eigen::Index kBlock = 1024;

// Parts of the products of one block of lines, one array each so that every sum is a plain dot product.
struct Block {
  Array yy, uu, one, cross_re, cross_im, y_re, y_im, u_re, u_im;
};

Block products(const Lines& lines, Eigen::Index first, Eigen::Index count) {
  const auto w = lines.weight.segment(first, count).array();
  const auto y = lines.output.segment(first, count).array();
  const auto u = lines.input.segment(first, count).array();
  Block b;
  b.one = w;
  b.y_re = w * y.real();
  b.y_im = w * y.imag();
  b.u_re = w * u.real();
  b.u_im = w * u.imag();
  b.yy = b.y_re * y.real() + b.y_im * y.imag();
  b.uu = b.u_re * u.real() + b.u_im * u.imag();
  b.cross_re = b.y_re * u.real() + b.y_im * u.imag();  // of conj(Y) U
  b.cross_im = b.y_re * u.imag() - b.y_im * u.real();
  return b;
}

double dot(const Array& a, const Array& b) { return a.matrix().dot(b.matrix()); }

// Re(x z^m) = Re x cos(m w) + Im x sin(m w), and with the other sign for z^-m.
void add(Eigen::VectorXd& sums, Eigen::Index order, Eigen::Index m, const Array& re, const Array& im, const Array& cosine,
         const Array& sine) {
  const double even = dot(re, cosine), odd = dot(im, sine);
  sums[order + m] += even + odd;
  if (m > 0) sums[order - m] += even - odd;
}

// cos and sin of w over `count` consecutive lines from the one of `first_omega`, by angle addition with a table from line 0.
void rotate(const Array& table_cos, const Array& table_sin, double first_omega, Eigen::Index count, Array& cosine, Array& sine) {
  const double c = std::cos(first_omega), s = std::sin(first_omega);
  cosine = c * table_cos.head(count) - s * table_sin.head(count);
  sine = s * table_cos.head(count) + c * table_sin.head(count);
}

}  // namespace

LineSums line_sums(const Lines& lines, Eigen::Index order) {
  LineSums s;
  s.order = order;
  for (auto* v : {&s.yy, &s.uu, &s.one}) v->setZero(order + 1);
  for (auto* v : {&s.yu, &s.y, &s.u}) v->setZero(2 * order + 1);
  const Array step = Array::LinSpaced(kBlock, 0.0, static_cast<double>(kBlock - 1)) * (2.0 * std::numbers::pi) /
                     static_cast<double>(lines.samples);
  const Array table_cos = step.cos(), table_sin = step.sin();
  Array cosine, sine, cosine_m, sine_m, cosine_before, sine_before, next;
  for (Eigen::Index first = 0; first < lines.size(); first += kBlock) {
    const Eigen::Index count = std::min(kBlock, lines.size() - first);
    const Block b = products(lines, first, count);
    rotate(table_cos, table_sin, lines.omega(first), count, cosine, sine);
    cosine_m = Array::Ones(count);
    sine_m = Array::Zero(count);
    cosine_before = cosine;  // cos(-w)
    sine_before = -sine;
    for (Eigen::Index m = 0; m <= order; ++m) {
      s.yy[m] += dot(b.yy, cosine_m);
      s.uu[m] += dot(b.uu, cosine_m);
      s.one[m] += dot(b.one, cosine_m);
      add(s.yu, order, m, b.cross_re, b.cross_im, cosine_m, sine_m);
      add(s.y, order, m, b.y_re, b.y_im, cosine_m, sine_m);
      add(s.u, order, m, b.u_re, b.u_im, cosine_m, sine_m);
      next = 2.0 * cosine * cosine_m - cosine_before;
      cosine_before.swap(cosine_m);
      cosine_m.swap(next);
      next = 2.0 * cosine * sine_m - sine_before;
      sine_before.swap(sine_m);
      sine_m.swap(next);
    }
  }
  const double scale = 1.0 / lines.total_weight();
  for (auto* v : {&s.yy, &s.uu, &s.one, &s.yu, &s.y, &s.u}) *v *= scale;
  return s;
}

Eigen::MatrixXd LineSums::normal_matrix(bool transient) const {
  const Eigen::Index n = order, t = transient ? n : 0, powers = n + 1;
  Eigen::MatrixXd sigma(t + 2 * powers, t + 2 * powers);
  const auto at = [&](const Eigen::VectorXd& sums, Eigen::Index m) { return sums[n + m]; };
  // Column j of a group of width w holds z^(w-1-j).
  for (Eigen::Index i = 0; i < powers; ++i) {
    for (Eigen::Index j = 0; j < powers; ++j) {
      sigma(t + i, t + j) = yy[std::abs(i - j)];
      sigma(t + powers + i, t + powers + j) = uu[std::abs(i - j)];
      sigma(t + i, t + powers + j) = sigma(t + powers + j, t + i) = at(yu, i - j);  // conj(Y z^(n-i)) U z^(n-j)
    }
  }
  for (Eigen::Index i = 0; i < t; ++i) {
    for (Eigen::Index j = 0; j < t; ++j) sigma(i, j) = one[std::abs(i - j)];
    for (Eigen::Index j = 0; j < powers; ++j) {  // conj(z^(n-1-i)) Y z^(n-j)
      sigma(i, t + j) = sigma(t + j, i) = at(y, i + 1 - j);
      sigma(i, t + powers + j) = sigma(t + powers + j, i) = at(u, i + 1 - j);
    }
  }
  return sigma;
}

}  // namespace bodeflow::koopmans_levin
