#include "biquads_block.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::filters {
namespace {

constexpr std::size_t kMostSections = 4096;

numerics::Biquad section_of(const Matrix& m, std::size_t i) {
  const std::string row = "row " + std::to_string(i + 1) + " of coefficients";
  for (std::size_t j = 0; j < 6; ++j) {
    if (!std::isfinite(m(i, j))) fail(row + " holds a value that is not finite");
  }
  const double a0 = m(i, 3);
  if (a0 == 0) fail(row + ": a0 is 0, allowed: any other value");
  const numerics::Biquad k{m(i, 0) / a0, m(i, 1) / a0, m(i, 2) / a0, m(i, 4) / a0, m(i, 5) / a0};
  if (!(std::abs(k.a2) < 1 && std::abs(k.a1) < 1 + k.a2)) fail(row + ": its poles lie on or outside the unit circle");
  return k;
}

}  // namespace

void Biquads::describe(Describe& d) {
  d.id("filters.biquads").summary("Second-order sections with given coefficients, in series or side by side.").cost_ns(10);
  d.doc(
      "H(z) = (b0 + b1 z^-1 + b2 z^-2) / (a0 + a1 z^-1 + a2 z^-2) for each row b0, b1, b2, a0, a1, a2, the layout of SciPy's and "
      "MATLAB's sos; transposed direct form II. series: one filter, the same on every channel. bank: every channel of the input "
      "becomes one channel a row, eight at a time in the vector unit.");
  d.required<Matrix>("coefficients").doc("one row a section: b0, b1, b2, a0, a1, a2");
  d.parameter("arrangement", "series")
      .choices({"series", "bank"})
      .doc("rows after each other, or each with an output of its own");
  describe_ports(d);
}

void Biquads::configure(const Parameters& p) {
  const Matrix m = p.matrix("coefficients");
  if (m.rows == 0 || m.columns != 6) fail("coefficients needs rows of six: b0, b1, b2, a0, a1, a2");
  if (m.rows > kMostSections)
    fail("coefficients has " + std::to_string(m.rows) + " rows, allowed: " + std::to_string(kMostSections));
  bank_ = p.text("arrangement") == "bank";
  for (std::size_t i = 0; i < m.rows; ++i) sections_.push_back(section_of(m, i));
}

std::vector<BankFilter> Biquads::design(double) const {
  if (!bank_) return {{"filter", sections_}};
  std::vector<BankFilter> filters;
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    filters.push_back({"section " + std::to_string(i + 1), numerics::Sections{sections_[i]}});
  }
  return filters;
}

std::string Biquads::kind() const {
  return std::to_string(sections_.size()) + (bank_ ? " second-order sections side by side" : " second-order sections in series");
}

}  // namespace bodeflow::filters
