#include "multisine_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "crest_optimiser.hpp"
#include "fourier_sum.hpp"
#include "multisine_parameters.hpp"
#include "source.hpp"

namespace bodeflow::generators {
namespace {

// Steps of the Fourier sums of all signals, about ten seconds.
constexpr double kMostSteps = 4e9;
// Points computed by the optimiser for all signals, about twenty seconds.
constexpr double kMostOptimiserPoints = 4e8;
// Values kept in memory: 1 GiB.
constexpr double kMostValues = 134217728;
// Signals up to this size are computed while a graph is checked.
constexpr double kQuickValues = 1 << 20;
// Lines that are told to other blocks, at most.
constexpr std::size_t kMostNotedLines = 100000;

Phases phases_named(const std::string& name) {
  if (name == "random") return Phases::random;
  if (name == "zero") return Phases::zero;
  return name == "optimised" ? Phases::optimised : Phases::schroeder;
}

bool quick_size(std::int64_t size) {
  for (const int factor : {2, 3, 5}) {
    while (size % factor == 0) size /= factor;
  }
  return size == 1;
}

std::string near_sizes(std::int64_t size) {
  std::int64_t below = size, above = size;
  while (!quick_size(below)) --below;
  while (!quick_size(above)) ++above;
  return std::to_string(below) + " or " + std::to_string(above);
}

}  // namespace

void Multisine::describe(Describe& d) {
  d.id("generators.multisine")
      .summary("Gives periodic sums of cosines on chosen spectral lines, for one input or several.")
      .role("source")
      .realtime_safe()
      .cost_ns(0.5);
  d.doc(
      "x[n] = sum_i a_i cos(2 pi k_i n / N + phi_i), line k at k sample_rate / N. One period is computed to rounding when the "
      "run begins, "
      "then played back. Schroeder phases give a crest factor near 1.7 for flat spectra on evenly spaced lines; optimised ones "
      "1.4 from the first "
      "line on and 1.6 in a narrow band, between the samples as well; random ones a new realisation with each seed, near 3. With "
      "`inputs: n` there are n "
      "channels and n experiments of experiment_periods periods each, in which the channels' spectra are multiplied by an "
      "orthogonal matrix; "
      "`realisations` repeats them with new random phases, and then the stream ends. The crest factor reached is in the log.");
  d.reference(
      "M. R. Schroeder, Synthesis of low-peak-factor signals and binary sequences with low autocorrelation, 1970, "
      "doi:10.1109/TIT.1970.1054411");
  d.reference("R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapters 4 and 5");
  d.reference(
      "P. Guillaume, J. Schoukens, R. Pintelon, I. Kollar, Crest-factor minimization using nonlinear Chebyshev approximation "
      "methods, "
      "1991, doi:10.1109/19.119778");
  d.reference(
      "T. P. Dobrowiecki, J. Schoukens, P. Guillaume, Optimized excitation signals for MIMO frequency response function "
      "measurements, "
      "2006");
  describe_source(d);
  d.required<std::int64_t>("period").range(4, 1 << 28).doc("samples of a period, N; factors of 2, 3 and 5 are prepared fastest");
  describe_lines(d);
  d.parameter("amplitude", std::vector<double>{1.0})
      .unit("")
      .doc("peak value of each line's cosine: one value for all lines, or one a line named (detection lines counted)");
  d.optional<std::vector<double>>("spectrum.frequencies")
      .unit("Hz")
      .doc("in place of amplitude: points of a curve over frequency, rising");
  d.optional<std::vector<double>>("spectrum.amplitudes")
      .unit("")
      .doc("peak values at these points; between them straight in a doubly logarithmic plot");
  d.optional<std::vector<double>>("rms").unit("").doc(
      "scales the signal to this root mean square: one value, or one a channel; then only the shape of the amplitudes counts");
  d.optional<std::vector<double>>("peak").unit("").doc(
      "scales the signal to this largest value over all experiments: one value, or one a channel");
  d.parameter("phases", "schroeder").choices({"schroeder", "random", "zero", "optimised"}).doc("of the lines; see above");
  d.optional<std::int64_t>("periods").range(1, 1e12).doc(
      "the stream ends after as many periods; without it, it has no end of its own");
  d.parameter("inputs", std::int64_t{1}).range(1, 64).doc("channels, and experiments of each realisation");
  d.optional<std::int64_t>("experiment_periods")
      .range(1, 1e9)
      .doc("periods of each experiment, those with its transient counted");
  d.parameter("realisations", std::int64_t{1}).range(1, 10000).doc("repetitions of the experiments with new random phases");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes random phases; without it the run's seed and the block's name do");
  d.stream_out(out);
}

void Multisine::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  design_ = Design();
  design_.period = whole(p, "period", 4, 1 << 28);
  design_.phases = phases_named(p.text("phases"));
  own_seed_ = p.has("seed");
  seed_ = own_seed_ ? static_cast<std::uint64_t>(p.integer("seed")) : 0;
  signals_.reset();
  take_lines(p);
  take_experiments(p);
  take_levels(p);
  require_preparable();
}

void Multisine::take_lines(const Parameters& p) {
  const LineNumbers named = named_lines(p, design_.period);
  const LineNumbers excited = excited_lines(p, named);
  const std::vector<double> amplitudes = named_amplitudes(p, named, rate_.hz() / static_cast<double>(design_.period));
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (std::binary_search(excited.begin(), excited.end(), named[i])) design_.lines.push_back({named[i], amplitudes[i], 0.0});
  }
  if (std::all_of(design_.lines.begin(), design_.lines.end(), [](const Line& line) { return line.amplitude == 0; }))
    fail("all amplitudes are zero");
}

void Multisine::take_experiments(const Parameters& p) {
  design_.inputs = static_cast<std::size_t>(whole(p, "inputs", 1, 64));
  design_.realisations = static_cast<std::size_t>(whole(p, "realisations", 1, 10000));
  const bool several = design_.inputs > 1 || design_.realisations > 1;
  experiment_periods_ = p.has("experiment_periods") ? whole(p, "experiment_periods", 1, 1'000'000'000) : -1;
  if (several && experiment_periods_ < 0)
    fail("inputs and realisations need experiment_periods, the number of periods of each experiment");
  if (experiment_periods_ > 0 && p.has("periods")) {
    fail("periods is given as well as experiment_periods; the stream ends after realisations x inputs x experiment_periods");
  }
  if (design_.realisations > 1 && (design_.phases == Phases::schroeder || design_.phases == Phases::zero))
    fail("phases are " + p.text("phases") + ", the same in all realisations; allowed: random, optimised");
  std::int64_t periods = p.has("periods") ? p.integer("periods") : -1;
  if (experiment_periods_ > 0) periods = experiment_periods_ * p.integer("inputs") * p.integer("realisations");
  length_ = -1;
  if (periods < 0) return;
  if (periods > INT64_MAX / design_.period) fail(std::to_string(periods) + " periods have more samples than can be counted");
  length_ = periods * design_.period;
}

void Multisine::take_levels(const Parameters& p) {
  if (p.has("rms") && p.has("peak")) fail("rms is given as well as peak; allowed: one of the two");
  for (const char* name : {"rms", "peak"}) {
    if (!p.has(name)) continue;
    std::vector<double> levels = p.numbers(name);
    if (levels.size() == 1) levels.resize(design_.inputs, levels[0]);
    if (levels.size() != design_.inputs) {
      fail(std::string(name) + " has " + std::to_string(levels.size()) + " values, allowed: 1, or one for each of the " +
           std::to_string(design_.inputs) + " inputs");
    }
    if (std::any_of(levels.begin(), levels.end(), [](double level) { return !(level > 0); }))
      fail(std::string(name) + " is not above zero");
    (*name == 'r' ? design_.rms : design_.peak) = levels;
  }
}

void Multisine::require_preparable() const {
  const auto steps = static_cast<double>(FourierSum::sum_of_factors(design_.period));
  const double samples = static_cast<double>(design_.period) * static_cast<double>(design_.inputs * design_.realisations);
  if (steps * samples > kMostSteps && !quick_size(design_.period)) {
    fail("a period of " + std::to_string(design_.period) +
         " samples has large prime factors and takes too long to prepare; near it: " + near_sizes(design_.period));
  }
  if (steps * samples > kMostSteps || Experiments::values(design_) > kMostValues) {
    fail(std::to_string(design_.inputs * design_.realisations) + " signals of " + std::to_string(design_.period) +
         " samples take too much time or memory to prepare; shorten the period or run the realisations one by one");
  }
  const double points =
      static_cast<double>(descent_points(design_.lines)) * static_cast<double>(design_.inputs * design_.realisations);
  if (design_.phases == Phases::optimised && points > kMostOptimiserPoints) {
    fail("optimised phases of " + std::to_string(design_.inputs * design_.realisations) + " signals with lines up to " +
         std::to_string(design_.lines.back().k) + " take too long; allowed: random, schroeder, or fewer and lower lines");
  }
}

void Multisine::resolve(Facts& f) {
  StreamFacts& facts = f.out(out);
  facts = source_facts(rate_, unit_, static_cast<int>(design_.inputs), length_);
  note_signal(facts);
}

void Multisine::note_signal(StreamFacts& facts) {
  const double period_s = static_cast<double>(design_.period) / rate_.hz();
  facts.notes["excitation.period"] = {period_s};
  if (experiment_periods_ > 0 && length_ / design_.period != experiment_periods_)
    facts.notes["excitation.experiment"] = {static_cast<double>(experiment_periods_) * period_s};
  const bool many = design_.lines.size() > kMostNotedLines;
  if (!many) {
    std::vector<double>& frequencies = facts.notes["excitation.frequencies"];
    for (const Line& line : design_.lines) frequencies.push_back(static_cast<double>(line.k) / period_s);
  }
  // Other signals wait for the run's seed, or would make a check slow.
  const bool quick = Experiments::values(design_) <= kQuickValues && design_.phases != Phases::optimised &&
                     (own_seed_ || !Experiments::seeded(design_));
  if (quick) {
    prepare(seed_);
    facts.notes["excitation.crest_factor"] = {signals_->crest_factor()};
  }
  double power = 0;
  for (const Line& line : design_.lines) power += 0.5 * line.amplitude * line.amplitude;
  std::vector<double> scales(design_.inputs, 1.0);
  if (quick) scales = signals_->scales();
  if (!design_.rms.empty()) {
    for (std::size_t j = 0; j < scales.size(); ++j) scales[j] = design_.rms[j] / std::sqrt(power);
  }
  const bool known = quick || design_.peak.empty();
  const bool equal = std::all_of(scales.begin(), scales.end(), [&scales](double scale) { return scale == scales[0]; });
  if (many || !known || !equal) return;
  std::vector<double>& amplitudes = facts.notes["excitation.amplitudes"];
  for (const Line& line : design_.lines) amplitudes.push_back(std::abs(line.amplitude) * scales[0]);
}

void Multisine::prepare(std::uint64_t seed) {
  if (signals_ && (signals_seed_ == seed || !Experiments::seeded(design_))) return;
  signals_ = std::make_unique<Experiments>(design_, seed);
  signals_seed_ = seed;
}

void Multisine::activate(const Activation& a) {
  prepare(own_seed_ ? seed_ : a.seed);
  log_info(summary());
}

std::string Multisine::summary() const {
  const double line_distance_hz = rate_.hz() / static_cast<double>(design_.period);
  char text[120];
  std::snprintf(text, sizeof text, "%zu lines from %s to %s, crest factor %.2f", design_.lines.size(),
                hertz(static_cast<double>(design_.lines.front().k) * line_distance_hz).c_str(),
                hertz(static_cast<double>(design_.lines.back().k) * line_distance_hz).c_str(), signals_->crest_factor());
  std::string result = text;
  if (design_.inputs > 1) result += ", " + std::to_string(design_.inputs) + " orthogonal experiments";
  if (design_.realisations > 1) result += ", " + std::to_string(design_.realisations) + " realisations";
  return result;
}

void Multisine::process(Io& io) {
  const std::uint64_t begin = io.position();
  const std::uint64_t wanted = before_end(io, length_);
  const auto period = static_cast<std::uint64_t>(design_.period);
  for (std::size_t j = 0; j < design_.inputs; ++j) {
    const auto y = io.write(out, static_cast<int>(j));
    for (std::uint64_t done = 0; done < wanted;) {
      const std::uint64_t number = (begin + done) / period, at = (begin + done) % period;
      const std::uint64_t part = std::min(wanted - done, period - at);
      const std::uint64_t experiment = experiment_periods_ > 0 ? number / static_cast<std::uint64_t>(experiment_periods_) : 0;
      signals_->copy(static_cast<std::size_t>(experiment / design_.inputs), static_cast<std::size_t>(experiment % design_.inputs),
                     j, static_cast<std::size_t>(at), y.subspan(static_cast<std::size_t>(done), static_cast<std::size_t>(part)));
      done += part;
    }
    std::fill(y.begin() + static_cast<std::ptrdiff_t>(wanted), y.end(), 0.0);
  }
}

}  // namespace bodeflow::generators
