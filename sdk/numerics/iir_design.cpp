#include "bodeflow/numerics/iir_design.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double kWorstSections = 1e-6;        // of the largest gain
constexpr double kMostAtNyquist = 0.1;         // of a prototype that is sampled
constexpr int kMostImpulseInvariantOrder = 8;  // above, the numerator's roots lose too many digits

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Eigen::VectorXcd with_more(const Eigen::VectorXcd& roots, Eigen::Index count, Complex value) {
  Eigen::VectorXcd more(roots.size() + count);
  more << roots, Eigen::VectorXcd::Constant(count, value);
  return more;
}

Complex product_of_negatives(const Eigen::VectorXcd& roots) { return roots.size() == 0 ? Complex(1) : (-roots).prod(); }

ZeroPoleGain low_pass(ZeroPoleGain h, double edge) {
  h.gain *= std::pow(edge, static_cast<double>(h.poles.size() - h.zeros.size()));
  h.zeros *= edge;
  h.poles *= edge;
  return h;
}

// s -> edge / s.
ZeroPoleGain high_pass(const ZeroPoleGain& h, double edge) {
  ZeroPoleGain to = h;
  to.gain = h.gain * (product_of_negatives(h.zeros) / product_of_negatives(h.poles)).real();
  to.zeros = with_more(edge * h.zeros.cwiseInverse(), h.poles.size() - h.zeros.size(), 0);
  to.poles = edge * h.poles.cwiseInverse();
  return to;
}

// Both solutions s of s^2 - 2 half s + centre^2 = 0 for each value; conjugates stay neighbours in the sense of split_roots.
Eigen::VectorXcd band_roots(const Eigen::VectorXcd& half, double centre) {
  Eigen::VectorXcd roots(2 * half.size());
  for (Eigen::Index i = 0; i < half.size(); ++i) {
    const Complex root = std::sqrt(half[i] * half[i] - centre * centre);
    roots[2 * i] = half[i] + root;
    roots[2 * i + 1] = half[i] - root;
  }
  return roots;
}

// s -> (s^2 + low high) / (s (high - low)).
ZeroPoleGain band_pass(const ZeroPoleGain& h, double low, double high) {
  const double width = high - low, centre = std::sqrt(low * high);
  const Eigen::Index degree = h.poles.size() - h.zeros.size();
  ZeroPoleGain to = h;
  to.gain = h.gain * std::pow(width, static_cast<double>(degree));
  to.zeros = with_more(band_roots(0.5 * width * h.zeros, centre), degree, 0);
  to.poles = band_roots(0.5 * width * h.poles, centre);
  return to;
}

// s -> s (high - low) / (s^2 + low high).
ZeroPoleGain band_stop(const ZeroPoleGain& h, double low, double high) {
  const double width = high - low, centre = std::sqrt(low * high);
  const Eigen::Index degree = h.poles.size() - h.zeros.size();
  ZeroPoleGain to = h;
  to.gain = h.gain * (product_of_negatives(h.zeros) / product_of_negatives(h.poles)).real();
  to.zeros = with_more(with_more(band_roots(0.5 * width * h.zeros.cwiseInverse(), centre), degree, {0.0, centre}), degree,
                       {0.0, -centre});
  to.poles = band_roots(0.5 * width * h.poles.cwiseInverse(), centre);
  return to;
}

ZeroPoleGain transformed(const ZeroPoleGain& prototype, Pass pass, const std::array<double, 2>& edges) {
  switch (pass) {
    case Pass::low:
      return low_pass(prototype, edges[0]);
    case Pass::high:
      return high_pass(prototype, edges[0]);
    case Pass::band:
      return band_pass(prototype, edges[0], edges[1]);
    case Pass::stop:
      return band_stop(prototype, edges[0], edges[1]);
  }
  return prototype;
}

ZeroPoleGain bilinear(const ZeroPoleGain& h) {
  const auto mapped = [](const Eigen::VectorXcd& roots) -> Eigen::VectorXcd {
    return (2.0 + roots.array()) / (2.0 - roots.array());
  };
  const auto factor = [](const Eigen::VectorXcd& roots) { return roots.size() == 0 ? Complex(1) : (2.0 - roots.array()).prod(); };
  ZeroPoleGain to;
  to.sample_time = 1.0;
  to.zeros = with_more(mapped(h.zeros), h.poles.size() - h.zeros.size(), -1);
  to.poles = mapped(h.poles);
  to.gain = h.gain * (factor(h.zeros) / factor(h.poles)).real();
  return to;
}

Complex value_at(const ZeroPoleGain& h, Complex x) {
  Complex value = h.gain;
  const Eigen::Index zeros = h.zeros.size();
  // By turns, so that neither product leaves the range.
  for (Eigen::Index i = 0; i < h.poles.size(); ++i) value *= (i < zeros ? x - h.zeros[i] : Complex(1)) / (x - h.poles[i]);
  return value;
}

// The residues of a filter without zeros, by its poles.
Eigen::VectorXcd residues(const ZeroPoleGain& h) {
  Eigen::VectorXcd alpha(h.poles.size());
  for (Eigen::Index i = 0; i < alpha.size(); ++i) {
    alpha[i] = h.gain;
    for (Eigen::Index m = 0; m < h.zeros.size(); ++m) alpha[i] *= h.poles[i] - h.zeros[m];
    for (Eigen::Index j = 0; j < alpha.size(); ++j)
      if (j != i) alpha[i] /= h.poles[i] - h.poles[j];
  }
  return alpha;
}

// sum_i alpha_i z / (z - exp(p_i)) as roots. Beyond order 1 the impulse response begins with sum_i alpha_i = 0.
Expected<ZeroPoleGain> sampled(const ZeroPoleGain& h) {
  const Eigen::VectorXcd alpha = residues(h), poles = h.poles.array().exp();
  const Eigen::Index n = poles.size();
  Eigen::VectorXcd numerator = Eigen::VectorXcd::Zero(n);  // descending, z left out
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXcd others = Eigen::VectorXcd::Zero(n);
    others[0] = 1;
    Eigen::Index degree = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (j == i) continue;
      for (Eigen::Index k = ++degree; k > 0; --k) others[k] -= poles[j] * others[k - 1];
    }
    numerator += alpha[i] * others;
  }
  const Eigen::Index lead = n > 1 ? 1 : 0;
  const Eigen::VectorXd real = numerator.real().tail(n - lead);
  const auto zeros = roots(real);
  if (!zeros) return tl::make_unexpected(zeros.error());
  ZeroPoleGain to;
  to.sample_time = 1.0;
  to.zeros = with_more(*zeros, 1, 0);
  to.poles = poles;
  to.gain = real[0];
  return to;
}

// Angles at which a realisation shows its errors: the edges, the ends, and between.
std::vector<double> telling_angles(const IirDesign& d) {
  const bool band = d.pass == Pass::band || d.pass == Pass::stop;
  const double low = d.edges[0], high = band ? d.edges[1] : d.edges[0];
  std::vector<double> angles{0, 0.1 * low, 0.5 * low, 0.9 * low, low, high, 0.5 * (low + high), std::sqrt(low * high), pi};
  for (const double x : {1.1, 2.0, 10.0}) angles.push_back(std::min(x * high, pi));
  return angles;
}

// Largest difference between what the sections do and `exact`, over the largest gain.
template <class Exact>
double error_of(const Sections& sections, const std::vector<double>& angles, Exact&& exact) {
  double worst = 0, largest = 0;
  for (const double w : angles) {
    const Complex wanted = exact(w);
    worst = std::max(worst, std::abs(response(sections, w) - wanted));
    largest = std::max(largest, std::abs(wanted));
  }
  return worst / largest;
}

std::string wrong_edges(const IirDesign& d) {
  const bool band = d.pass == Pass::band || d.pass == Pass::stop;
  for (int i = 0; i < (band ? 2 : 1); ++i) {
    const double edge = d.edges[static_cast<std::size_t>(i)];
    if (!(edge > 0 && edge < pi))
      return "the edge w h = " + text_of(edge) + " rad must lie between 0 and pi (the Nyquist frequency)";
  }
  if (band && !(d.edges[0] < d.edges[1])) return "the lower edge of the band must lie below the upper one";
  return "";
}

std::string not_invariant(const IirDesign& d, const ZeroPoleGain& analogue) {
  if (d.pass == Pass::high || d.pass == Pass::stop) {
    return "impulse invariance is for low-pass and band-pass filters: what passes above the Nyquist frequency would fold down";
  }
  if (d.kind == FilterKind::chebyshev_2 || d.kind == FilterKind::elliptic) {
    return "impulse invariance is for butterworth, chebyshev_1 and bessel: the others do not fall off above their stop band";
  }
  if (d.order > kMostImpulseInvariantOrder) {
    return "impulse invariance of order " + std::to_string(d.order) + ": allowed are 1 to " +
           std::to_string(kMostImpulseInvariantOrder);
  }
  const double left = std::abs(value_at(analogue, {0.0, pi}));
  if (left > kMostAtNyquist) {
    return "impulse invariance: the continuous-time filter still has the gain " + text_of(left) +
           " at the Nyquist frequency and would fold down; allowed is up to " + text_of(kMostAtNyquist) +
           ": lower edges, a higher order, or the bilinear transformation";
  }
  return "";
}

Expected<IirFilter> realised(const IirDesign& d, ZeroPoleGain roots, double* error, const ZeroPoleGain* analogue) {
  auto sections = to_sections(roots);
  if (!sections) return tl::make_unexpected(sections.error());
  if (analogue == nullptr) {
    *error = error_of(*sections, telling_angles(d), [&](double w) { return value_at(roots, std::polar(1.0, w)); });
  } else {
    const Eigen::VectorXcd alpha = residues(*analogue);
    *error = error_of(*sections, telling_angles(d), [&](double w) {
      const Complex z = std::polar(1.0, w);
      return (alpha.array() * z / (z - analogue->poles.array().exp())).sum();
    });
  }
  return IirFilter{std::move(roots), std::move(*sections)};
}

}  // namespace

Expected<IirFilter> design_iir(const IirDesign& d) {
  const auto prototype = analogue_prototype(d.kind, d.order, d.ripple_db, d.attenuation_db);
  if (!prototype) return tl::make_unexpected(prototype.error());
  if (std::string wrong = wrong_edges(d); !wrong.empty()) return refused(std::move(wrong));
  std::array<double, 2> edges = d.edges;
  if (!d.impulse_invariant)
    for (double& edge : edges) edge = 2 * std::tan(edge / 2);
  const ZeroPoleGain analogue = transformed(*prototype, d.pass, edges);
  double error = 0;
  Expected<IirFilter> filter;
  if (d.impulse_invariant) {
    if (std::string wrong = not_invariant(d, analogue); !wrong.empty()) return refused(std::move(wrong));
    auto roots = sampled(analogue);
    if (!roots) return tl::make_unexpected(roots.error());
    filter = realised(d, std::move(*roots), &error, &analogue);
  } else {
    filter = realised(d, bilinear(analogue), &error, nullptr);
  }
  if (filter && !(error < kWorstSections)) {
    return refused("the edges lie too near zero or to each other for order " + std::to_string(d.order) +
                   ": double precision gives this filter only to " + text_of(error) +
                   " of its gain; allowed is 1e-06 (a lower sample rate or a lower order)");
  }
  return filter;
}

}  // namespace bodeflow::numerics
