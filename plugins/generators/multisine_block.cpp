#include "multisine_block.hpp"

#include <algorithm>
#include <cstdio>

#include "source.hpp"

namespace bodeflow::generators {

void Multisine::describe(Describe& d) {
  d.id("generators.multisine")
      .summary("Gives a periodic sum of cosines on chosen spectral lines.")
      .role("source")
      .realtime_safe()
      .cost_ns(0.2);
  d.doc(
      "x[n] = sum_i a_i cos(2 pi k_i n / N + phi_i), line k at k sample_rate / N. One period is computed to rounding when the "
      "run begins, then played "
      "back. Schroeder phases phi_i = -i (i - 1) pi / M give a crest factor near 1.7 for equal amplitudes on evenly spaced "
      "lines; random phases "
      "give a new realisation with each seed, with a crest factor near 3. The crest factor reached is in the log.");
  d.reference(
      "M. R. Schroeder, Synthesis of low-peak-factor signals and binary sequences with low autocorrelation, 1970, "
      "doi:10.1109/TIT.1970.1054411");
  d.reference("R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapter 5");
  describe_source(d);
  d.required<std::int64_t>("period").range(4, 1 << 28).doc("samples of a period, N; factors of 2, 3 and 5 are prepared fastest");
  d.optional<std::int64_t>("lines.first").range(1, 1 << 28).doc("first excited line");
  d.optional<std::int64_t>("lines.last").range(1, 1 << 28).doc("last line that may be excited, below N / 2");
  d.parameter("lines.step", std::int64_t{1})
      .range(1, 1 << 28)
      .doc("distance of excited lines: 2 with an odd first line excites odd lines only");
  d.optional<std::vector<std::int64_t>>("lines.list")
      .range(1, 1 << 28)
      .doc("excited lines one by one, ascending, in place of first, last and step");
  d.parameter("amplitude", std::vector<double>{1.0})
      .unit("")
      .doc("peak value of each line's cosine: one value for all lines, or one a line");
  d.parameter("phases", "schroeder").choices({"schroeder", "random", "zero"}).doc("of the lines; see above");
  d.optional<std::int64_t>("periods").range(1, 1e12).doc(
      "the stream ends after as many periods; without it, it has no end of its own");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes random phases; without it the run's seed and the block's name do");
  d.stream_out(out).doc("one channel");
}

void Multisine::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  period_length_ = p.integer("period");
  if (p.has("periods")) length_ = period_length_ * p.integer("periods");
  random_phases_ = p.text("phases") == "random";
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));

  const std::vector<std::int64_t> lines = lines_of(p);
  const std::vector<double>& amplitudes = p.numbers("amplitude");
  if (amplitudes.size() != 1 && amplitudes.size() != lines.size()) {
    fail("amplitude has " + std::to_string(amplitudes.size()) + " values, allowed: 1, or one for each of the " +
         std::to_string(lines.size()) + " lines");
  }
  lines_.clear();
  const std::vector<double> phases =
      p.text("phases") == "schroeder" ? schroeder_phases(lines.size()) : std::vector<double>(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    lines_.push_back({lines[i], amplitudes[amplitudes.size() == 1 ? 0 : i], phases[i]});
}

void Multisine::resolve(Facts& f) { f.out(out) = source_facts(rate_, unit_, 1, length_); }

void Multisine::activate(const Activation& a) {
  if (random_phases_) {
    const std::vector<double> phases = random_phases(lines_.size(), numerics::Random(own_seed_ ? seed_ : a.seed));
    for (std::size_t i = 0; i < lines_.size(); ++i) lines_[i].phase_rad = phases[i];
  }
  period_ = synthesise(period_length_, lines_);
  char text[100];
  std::snprintf(text, sizeof text, "%zu lines from %s to %s, crest factor %.2f", lines_.size(),
                hertz(static_cast<double>(lines_.front().k) * rate_.hz() / static_cast<double>(period_length_)).c_str(),
                hertz(static_cast<double>(lines_.back().k) * rate_.hz() / static_cast<double>(period_length_)).c_str(),
                crest_factor(period_));
  log_info(text);
}

void Multisine::process(Io& io) {
  const auto y = io.write(out);
  std::size_t wanted = y.size();
  if (length_ >= 0) {
    const auto length = static_cast<std::uint64_t>(length_);
    const std::uint64_t left = length > io.position() ? length - io.position() : 0;
    if (left < wanted) {
      wanted = static_cast<std::size_t>(left);
      io.end_after(left);
      std::fill(y.begin() + static_cast<std::ptrdiff_t>(wanted), y.end(), 0.0);
    }
  }
  std::size_t at = static_cast<std::size_t>(io.position() % period_.size());
  for (std::size_t done = 0; done < wanted;) {
    const std::size_t part = std::min(wanted - done, period_.size() - at);
    std::copy_n(period_.begin() + static_cast<std::ptrdiff_t>(at), part, y.begin() + static_cast<std::ptrdiff_t>(done));
    done += part;
    at = 0;
  }
}

std::vector<std::int64_t> Multisine::lines_of(const Parameters& p) const {
  const bool range = p.has("lines.first") || p.has("lines.last") || p.given("lines.step");
  if (p.has("lines.list")) {
    if (range) fail("lines has a list as well as first, last or step; allowed: one of the two");
    const std::vector<std::int64_t> lines = p.integers("lines.list");
    if (lines.empty()) fail("lines.list is empty");
    if (std::adjacent_find(lines.begin(), lines.end(), std::greater_equal<>()) != lines.end())
      fail("lines.list is not ascending");
    require_within(lines.front());
    require_within(lines.back());
    return lines;
  }
  if (!p.has("lines.first") || !p.has("lines.last")) fail("lines needs first and last, or a list");
  const std::int64_t first = p.integer("lines.first"), last = p.integer("lines.last"), step = p.integer("lines.step");
  if (last < first) fail("lines.last " + std::to_string(last) + " is below lines.first " + std::to_string(first));
  if (step < 1) fail("lines.step is " + std::to_string(step) + ", allowed: at least 1");
  require_within(first);
  require_within(last);
  std::vector<std::int64_t> lines;
  for (std::int64_t k = first; k <= last; k += step > last - k ? last - k + 1 : step) lines.push_back(k);
  return lines;
}

void Multisine::require_within(std::int64_t line) const {
  const std::int64_t highest = (period_length_ - 1) / 2;
  if (line >= 1 && line <= highest) return;
  fail("line " + std::to_string(line) + " does not lie between zero and half of the period of " + std::to_string(period_length_) +
       " samples; allowed: 1 to " + std::to_string(highest));
}

}  // namespace bodeflow::generators
