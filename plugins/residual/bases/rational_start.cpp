#include "rational_start.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <complex>

#include "polynomial_start.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

constexpr int kReweightings = 15;
// The least damping ratio of a section to start from.
constexpr double kLeastDamping = 1e-4;

struct Lines {
  Eigen::VectorXcd x, response;
  Eigen::VectorXd weight;
};

Lines lines_of(std::span<const MeasuredResponse> measured, double unit) {
  const MeasuredResponse all = joined_lines(measured);
  const auto count = static_cast<Eigen::Index>(all.frequency_hz.size());
  Lines lines{Eigen::VectorXcd(count), Eigen::VectorXcd(count), Eigen::VectorXd(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    lines.x[k] = {0.0, 6.283185307179586 * all.frequency_hz[i] / unit};
    lines.response[k] = all.response[i];
    lines.weight[k] = all.weight[i];
  }
  return lines;
}

Complex value_at(const Eigen::VectorXd& ascending, Complex x) {
  Complex sum = 0.0;
  for (Eigen::Index i = ascending.size(); i-- > 0;) sum = sum * x + ascending[i];
  return sum;
}

/// Least squares over real and imaginary parts, columns of unit length.
Eigen::VectorXd solved(const Eigen::MatrixXcd& a, const Eigen::VectorXcd& right) {
  Eigen::MatrixXd both(2 * a.rows(), a.cols());
  both << a.real(), a.imag();
  Eigen::VectorXd b(2 * a.rows());
  b << right.real(), right.imag();
  const Eigen::VectorXd scale = both.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  both = both * scale.asDiagonal();
  return scale.asDiagonal() * both.colPivHouseholderQr().solve(b);
}

/// The numerator for a given denominator.
Eigen::VectorXd numerator_for(const Lines& l, const Eigen::VectorXd& denominator, int order) {
  Eigen::MatrixXcd a(l.x.size(), order + 1);
  Eigen::VectorXcd right(l.x.size());
  for (Eigen::Index k = 0; k < l.x.size(); ++k) {
    Complex power = l.weight[k] / value_at(denominator, l.x[k]);
    for (int c = 0; c <= order; ++c, power *= l.x[k]) a(k, c) = power;
    right[k] = l.weight[k] * l.response[k];
  }
  return solved(a, right);
}

Eigen::VectorXd denominator_for(const Lines& l, int order, int numerator_order) {
  Eigen::VectorXd d;
  for (int round = 0; round < kReweightings; ++round) {
    Eigen::MatrixXcd a(l.x.size(), order + numerator_order + 1);
    Eigen::VectorXcd right(l.x.size());
    for (Eigen::Index k = 0; k < l.x.size(); ++k) {
      const Complex before = d.size() == 0 ? std::pow(1.0 + l.x[k], order) : value_at(d, l.x[k]);
      const Complex w = l.weight[k] / before;
      Complex power = w * l.response[k];
      for (int c = 0; c < order; ++c, power *= l.x[k]) a(k, c) = power;
      right[k] = -power;
      power = -w;
      for (int c = 0; c <= numerator_order; ++c, power *= l.x[k]) a(k, order + c) = power;
    }
    const Eigen::VectorXd found = solved(a, right);
    if (!found.allFinite()) fail("no transfer function of these orders fits the measured response");
    d.resize(order + 1);
    d << found.head(order), 1.0;
  }
  return d;
}

/// p, q of the sections and r, all in the left half plane.
std::vector<double> stable_sections(const Eigen::VectorXd& denominator) {
  const auto roots = numerics::roots(denominator.reverse());
  if (!roots) fail("no transfer function of these orders fits the measured response: " + roots.error().text);
  const auto parts = numerics::split_roots(*roots);
  if (!parts) fail("no transfer function of these orders fits the measured response: " + parts.error().text);
  std::vector<double> sections;
  for (const Complex& r : parts->pairs) {
    const double size = std::abs(r);
    sections.insert(sections.end(), {2.0 * std::max(std::abs(r.real()), kLeastDamping * size), size * size});
  }
  std::vector<double> real;
  for (const double r : parts->real) real.push_back(std::max(std::abs(r), kLeastDamping));
  for (std::size_t i = 0; i + 1 < real.size(); i += 2)
    sections.insert(sections.end(), {real[i] + real[i + 1], real[i] * real[i + 1]});
  if (real.size() % 2 != 0) sections.push_back(real.back());
  return sections;
}

Eigen::VectorXd product(const std::vector<double>& sections) {
  Eigen::VectorXd d = Eigen::VectorXd::Ones(1);  // descending
  std::size_t i = 0;
  for (; i + 1 < sections.size(); i += 2) d = numerics::multiply(d, Eigen::Vector3d(1.0, sections[i], sections[i + 1]));
  if (i < sections.size()) d = numerics::multiply(d, Eigen::Vector2d(1.0, sections[i]));
  return d.reverse();
}

}  // namespace

RationalStart rational_start(std::span<const MeasuredResponse> measured, int order, int numerator_order, double unit_rad_s) {
  const Lines lines = lines_of(measured, unit_rad_s);
  if (2 * lines.x.size() < order + numerator_order + 1)
    fail("the base model needs " + std::to_string((order + numerator_order + 2) / 2) + " lines with a response, found " +
         std::to_string(lines.x.size()));
  RationalStart start;
  start.sections = stable_sections(denominator_for(lines, order, numerator_order));
  const Eigen::VectorXd n = numerator_for(lines, product(start.sections), numerator_order);
  if (!n.allFinite()) fail("no transfer function of these orders fits the measured response");
  start.numerator.assign(n.begin(), n.end());
  return start;
}

}  // namespace bodeflow::residual
