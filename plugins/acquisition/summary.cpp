#include "summary.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

// A signal that passes its crest rarely stays on the same digit for three samples; a clipped one does, again and again.
constexpr std::int64_t kRun = 3;
constexpr std::int64_t kRuns = 3;

}  // namespace

void SummaryOfColumn::Extreme::take(double x, bool beyond) {
  if (beyond) {
    value = x;
    run = 1;
    runs = 0;
  } else if (x == value) {
    if (++run == kRun) ++runs;
  } else {
    run = 0;
  }
}

void SummaryOfColumn::add(std::span<const double> values) {
  if (values.empty()) return;
  if (empty_) {
    first_ = least_.value = greatest_.value = values.front();
    empty_ = false;
  }
  for (std::size_t n = 0; n < values.size() && !between_; ++n) {
    const double x = values[n];
    if (x == first_) continue;
    if (!other_) other_ = x;
    between_ = x != *other_;
  }
  double least = values.front(), greatest = least;
  for (const double x : values) {
    least = x < least ? x : least;
    greatest = x > greatest ? x : greatest;
  }
  if (least > least_.value && greatest < greatest_.value) {  // most of a long signal: no sample is at an extreme
    least_.run = greatest_.run = 0;
    return;
  }
  for (const double x : values) {
    least_.take(x, x < least_.value);
    greatest_.take(x, x > greatest_.value);
  }
}

ColumnSummary SummaryOfColumn::result() const { return {least_.value, greatest_.value, least_.runs, greatest_.runs, between_}; }

int last_digit_of(std::string_view number) {
  const std::size_t e = number.find_first_of("eE");
  const std::string_view digits = number.substr(0, e);
  const std::size_t point = digits.find_first_of(".,");
  int exponent = point == std::string_view::npos ? 0 : -static_cast<int>(std::min<std::size_t>(digits.size() - point - 1, 400));
  if (e != std::string_view::npos) {
    int written = 0;
    const char* begin = number.data() + e + 1;
    const char* const end = number.data() + number.size();
    if (begin != end && *begin == '+') ++begin;
    std::from_chars(begin, end, written);
    exponent += std::abs(written) < 1000 ? written : 0;
  }
  return exponent;
}

std::string clipping_suspicion(const ColumnSummary& column) {
  if (!column.between) return "";
  std::string text;
  const auto side = [&text](std::int64_t runs, double value) {
    if (runs < kRuns) return;
    text += (text.empty() ? "" : " and ") + std::to_string(runs) + " times at " + number_text(value);
  };
  side(column.runs_at_least, column.least);
  side(column.runs_at_greatest, column.greatest);
  return text.empty() ? "" : "rests " + text + " for three samples or more: clipped?";
}

}  // namespace bodeflow::acquisition
