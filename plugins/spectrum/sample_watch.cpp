#include "sample_watch.hpp"

#include <cmath>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr std::int64_t kVisits = 3;  // a signal at rest for a while comes once
constexpr std::int64_t kOften = 4;   // times the samples next to the extreme; a quantised sine has 2.4 times as many

}  // namespace

void SampleWatch::note(Extreme& extreme, double x, double side) const {
  if (count_ == 0) {
    extreme = {x, 1, 1, x, 0};
  } else if (side * x > side * extreme.value) {
    extreme = {x, 1, 1, extreme.value, extreme.samples};
  } else if (x == extreme.value) {
    ++extreme.samples;
    if (x != last_) ++extreme.visits;
  } else if (extreme.next_samples == 0 || side * x > side * extreme.next) {
    extreme.next = x;
    extreme.next_samples = 1;
  } else if (x == extreme.next) {
    ++extreme.next_samples;
  }
}

std::size_t SampleWatch::add(std::span<const double> samples) {
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const double x = samples[n];
    if (!std::isfinite(x)) return n;
    note(greatest_, x, 1.0);
    note(least_, x, -1.0);
    last_ = x;
    ++count_;
  }
  return samples.size();
}

std::string SampleWatch::clipping(const std::string& name) const {
  if (constant() || greatest_.next == least_.value) return "";
  const auto clipped = [](const Extreme& e) { return e.visits >= kVisits && e.samples > kOften * e.next_samples; };
  std::string text;
  for (const Extreme* e : {&greatest_, &least_}) {
    if (!clipped(*e)) continue;
    const double share = 100.0 * static_cast<double>(e->samples) / static_cast<double>(count_);
    text += (text.empty() ? "" : " and ") + std::string(e == &greatest_ ? "greatest" : "least") + " value " +
            short_number(e->value) + " in " + short_number(share) + " % of its samples";
  }
  if (text.empty()) return "";
  return name + " has its " + text + ": it seems clipped; lower the amplitude or widen the range";
}

}  // namespace bodeflow::spectrum
