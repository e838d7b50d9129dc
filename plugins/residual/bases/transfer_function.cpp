#include "transfer_function.hpp"

#include <cmath>

#include "declared_timing.hpp"
#include "rational_start.hpp"

namespace bodeflow::residual {
namespace {

constexpr int kHighestOrder = 10;

}  // namespace

void TransferFunctionModel::describe(Describe& d) {
  d.id("residual.transfer_function")
      .summary("A black box: a stable transfer function of declared orders.")
      .doc(
          "N(x) / D(x), x = s / (2 pi reference_frequency), D as a product of sections of order 2 with positive coefficients. "
          "Its "
          "parameters have no physical meaning and it has no places: only effects of input, output and response (delay, lag, "
          "mode, "
          "feed-through, offset ...) can be added to it.");
  d.required<std::int64_t>("order").range(1, kHighestOrder).doc("of the denominator");
  d.required<std::int64_t>("numerator_order").range(0, kHighestOrder).doc("at most that of the denominator");
  d.required<double>("reference_frequency").unit("Hz").above(0.0).doc("in the middle of the band: coefficients count in it");
  d.parameter("magnitude", 1.0).unit("").above(0.0).doc("typical magnitude of the response");
  describe_timing(d, Hold::band_limited);
}

void TransferFunctionModel::configure(const Parameters& p) {
  order_ = static_cast<int>(p.integer("order"));
  numerator_order_ = static_cast<int>(p.integer("numerator_order"));
  reference_hz_ = p.number("reference_frequency");
  magnitude_ = p.number("magnitude");
  timing_ = read_timing(p);
  if (numerator_order_ > order_)
    fail("numerator_order = " + std::to_string(numerator_order_) + "; allowed: at most the order, " + std::to_string(order_));
}

double TransferFunctionModel::unit() const { return 6.283185307179586 * reference_hz_; }

std::vector<FitParameter> TransferFunctionModel::parameters() const {
  std::vector<FitParameter> all;
  for (int k = 0; k <= numerator_order_; ++k)
    all.push_back(real("numerator_" + std::to_string(k), "", magnitude_).says("coefficient of x^" + std::to_string(k)));
  for (int n = 1; n <= order_ / 2; ++n) {
    all.push_back(positive("section_" + std::to_string(n) + "_damping", "1").says("p of x^2 + p x + q"));
    all.push_back(positive("section_" + std::to_string(n) + "_stiffness", "1").says("q of x^2 + p x + q"));
  }
  if (order_ % 2 != 0) all.push_back(positive("real_pole", "1").says("r of x + r"));
  return all;
}

std::vector<std::string> TransferFunctionModel::conventions() const {
  std::vector<std::string> words = {"a black box of order " + std::to_string(order_) + " with a numerator of order " +
                                        std::to_string(numerator_order_) +
                                        ": only effects of input, output and response can be added, none inside the plant",
                                    "powers of s count in 2 pi " + short_text(reference_hz_) + " Hz"};
  for (std::string& text : timing_words(timing_)) words.push_back(std::move(text));
  return words;
}

std::vector<std::vector<double>> TransferFunctionModel::starts(std::span<const MeasuredResponse> measured) const {
  const RationalStart start = rational_start(measured, order_, numerator_order_, unit());
  std::vector<double> v = start.numerator;
  v.insert(v.end(), start.sections.begin(), start.sections.end());
  return {v};
}

std::vector<double> TransferFunctionModel::denominator(const double* v) const {
  std::vector<double> d = {1.0};
  const auto times = [&d](std::initializer_list<double> factor) {  // ascending
    std::vector<double> product(d.size() + factor.size() - 1, 0.0);
    for (std::size_t i = 0; i < d.size(); ++i)
      for (std::size_t j = 0; j < factor.size(); ++j) product[i + j] += d[i] * factor.begin()[j];
    d = std::move(product);
  };
  const double* next = v + numerator_order_ + 1;
  for (int n = 0; n < order_ / 2; ++n, next += 2) times({next[1], next[0], 1.0});
  if (order_ % 2 != 0) times({*next, 1.0});
  return d;
}

bool TransferFunctionModel::state_space(const double* v, const double*, LinearPlant& plant) const {
  const std::vector<double> d = denominator(v);
  for (const double c : d)
    if (!std::isfinite(c) || !(c > 0.0)) return false;
  plant.resize(order_, 1, 0);
  const auto n = static_cast<std::size_t>(order_), m = static_cast<std::size_t>(numerator_order_);
  const double direct = m == n ? v[n] : 0.0;
  // States x, x', ... in the time that counts in 1 / unit: a companion form of coefficients near 1.
  for (std::size_t i = 0; i + 1 < n; ++i) plant.A[i * n + i + 1] = unit();
  for (std::size_t j = 0; j < n; ++j) {
    plant.A[(n - 1) * n + j] = -unit() * d[j];
    plant.C[j] = (j <= m ? v[j] : 0.0) - direct * d[j];
  }
  plant.B[n - 1] = unit();
  plant.D[0] = direct;
  return true;
}

bool TransferFunctionModel::response(const double* v, const double*, std::complex<double> s, std::complex<double>* matrix) const {
  const std::complex<double> x = s / unit();
  std::complex<double> above = 0.0, below = 1.0;
  for (int k = numerator_order_; k >= 0; --k) above = above * x + v[k];
  const double* next = v + numerator_order_ + 1;
  for (int n = 0; n < order_ / 2; ++n, next += 2) below *= x * (x + next[0]) + next[1];
  if (order_ % 2 != 0) below *= x + *next;
  matrix[0] = above / below;
  return std::isfinite(matrix[0].real()) && std::isfinite(matrix[0].imag());
}

}  // namespace bodeflow::residual
