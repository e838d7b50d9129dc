#include "bodeflow/numerics/second_order_sections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;

// x^2 + linear x + constant, or x + linear (constant = 0, order 1), with the root that stands for it.
struct Factor {
  double linear = 0.0;
  double constant = 0.0;
  int order = 0;
  Complex root;
};

Factor of_pair(Complex p) { return {-2 * p.real(), std::norm(p), 2, p}; }
Factor of_reals(double a, double b) { return {-(a + b), a * b, 2, std::abs(a) > std::abs(b) ? a : b}; }
Factor of_real(double a) { return {-a, 0.0, 1, a}; }

// The poles as factors: pairs, real ones two by two, one alone where their number is odd; nearest to the unit circle first.
std::vector<Factor> pole_factors(RealRoots roots) {
  std::vector<Factor> factors;
  for (const Complex p : roots.pairs) factors.push_back(of_pair(p));
  std::vector<double>& real = roots.real;
  std::sort(real.begin(), real.end(), [](double a, double b) { return std::abs(a) > std::abs(b); });
  for (std::size_t i = 0; i + 1 < real.size(); i += 2) factors.push_back(of_reals(real[i], real[i + 1]));
  if (real.size() % 2 == 1) factors.push_back(of_real(real.back()));
  std::stable_sort(factors.begin(), factors.end(), [](const Factor& a, const Factor& b) {
    if (a.order != b.order) return a.order > b.order;
    return std::abs(a.root) > std::abs(b.root);
  });
  return factors;
}

// Zeros that are still free.
class Zeros {
 public:
  explicit Zeros(RealRoots roots) : pairs_(std::move(roots.pairs)), real_(std::move(roots.real)) {}

  // Those nearest to the pole, at most `order` of them.
  Factor take(Complex pole, int order) {
    if (order == 1) return real_.empty() ? Factor{} : of_real(take_real(pole));
    const bool two_real = real_.size() >= 2 || pairs_.empty();
    if (!pairs_.empty() && (!two_real || distance(pairs_, pole) <= distance(real_, pole))) {
      const auto place = nearest(pairs_, pole);
      const Complex zero = *place;
      pairs_.erase(place);
      return of_pair(zero);
    }
    if (real_.empty()) return {};
    const double first = take_real(pole);
    return real_.empty() ? of_real(first) : of_reals(first, take_real(pole));
  }

 private:
  template <class Roots>
  static typename Roots::iterator nearest(Roots& roots, Complex pole) {
    return std::min_element(roots.begin(), roots.end(),
                            [&](const auto& a, const auto& b) { return std::abs(a - pole) < std::abs(b - pole); });
  }
  template <class Roots>
  static double distance(Roots& roots, Complex pole) {
    return roots.empty() ? std::numeric_limits<double>::infinity() : std::abs(*nearest(roots, pole) - pole);
  }
  double take_real(Complex pole) {
    const auto place = nearest(real_, pole);
    const double zero = *place;
    real_.erase(place);
    return zero;
  }

  std::vector<Complex> pairs_;
  std::vector<double> real_;
};

// z^-order-of-the-section times both factors: a numerator of lower order than the denominator starts with zeros.
Biquad biquad(const Factor& pole, const Factor& zero) {
  Biquad k;
  k.a1 = pole.linear;
  k.a2 = pole.constant;
  const int delay = pole.order - zero.order;
  double b[3] = {};
  const double factor[3] = {1.0, zero.linear, zero.constant};
  for (int i = 0; i <= zero.order; ++i) b[delay + i] = factor[i];
  k.b0 = b[0];
  k.b1 = b[1];
  k.b2 = b[2];
  return k;
}

}  // namespace

Expected<Sections> to_sections(const ZeroPoleGain& filter) {
  if (!(filter.sample_time > 0)) return refused("second-order sections are of discrete-time filters");
  if (!std::isfinite(filter.gain)) return refused("the filter's gain is not finite");
  if (filter.zeros.size() > filter.poles.size()) return refused("the filter has more zeros than poles");
  auto poles = split_roots(filter.poles);
  if (!poles) return tl::make_unexpected(poles.error());
  auto zeros = split_roots(filter.zeros);
  if (!zeros) return tl::make_unexpected(zeros.error());
  if (filter.poles.size() > 0 && !(filter.poles.cwiseAbs().maxCoeff() < 1)) {
    return refused("the filter has a pole on or outside the unit circle");
  }
  Zeros free(std::move(*zeros));
  Sections sections;
  for (const Factor& pole : pole_factors(std::move(*poles))) sections.push_back(biquad(pole, free.take(pole.root, pole.order)));
  if (sections.empty()) sections.push_back({});
  std::reverse(sections.begin(), sections.end());
  Biquad& first = sections.front();
  first.b0 *= filter.gain;
  first.b1 *= filter.gain;
  first.b2 *= filter.gain;
  return sections;
}

std::complex<double> response(const Sections& sections, double w_h) {
  const Complex z = std::polar(1.0, w_h);
  Complex h = 1;
  for (const Biquad& k : sections) h *= ((k.b0 * z + k.b1) * z + k.b2) / ((z + k.a1) * z + k.a2);
  return h;
}

Eigen::VectorXd impulse_response(const Sections& sections, Eigen::Index count) {
  SectionFilter filter(sections);
  Eigen::VectorXd h(count);
  for (Eigen::Index n = 0; n < count; ++n) h[n] = filter.step(n == 0 ? 1.0 : 0.0);
  return h;
}

}  // namespace bodeflow::numerics
