#include "local_polynomial_block.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <limits>

namespace bodeflow::spectrum {
namespace {

constexpr const char* kPorts[] = {"input", "output", "reference"};
// A record of the estimate then stays below some hundred megabytes.
constexpr std::int64_t kMostLines = 1'000'000;

/// Sizes of memory and loops follow from these, so they are checked again.
std::int64_t in_range(const Parameters& p, const char* name, std::int64_t least, std::int64_t most) {
  const std::int64_t value = p.integer(name);
  if (value < least || value > most)
    fail(std::string(name) + " " + std::to_string(value) + "; allowed: " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

const In<double>& port_at(std::size_t port) {
  static constexpr In<double> ports[] = {LocalPolynomialBlock::input, LocalPolynomialBlock::output,
                                         LocalPolynomialBlock::reference};
  return ports[port];
}

}  // namespace

void LocalPolynomialBlock::describe(Describe& d) {
  d.id("spectrum.local_polynomial")
      .summary("Measures a frequency response from a record of any shape (noise, chirp, step) by local polynomials.")
      .cost_ns(200);
  d.doc(
      "Around each line of the whole record's spectrum, plant and transient are polynomials of the frequency, "
      "Y(k+r) = G(k+r) U(k+r) + T(k+r) + V(k+r), fitted by least squares over 2n + 1 lines: leakage and transients are removed, "
      "and the "
      "residuals give the noise level and the variance. The whole record is held in memory. The input must be rough from line to "
      "line. "
      "Biased where a resonance is narrow: with order 2 its height is wrong by 7 % at a 3 dB bandwidth of 2n lines, 1.4 % at 4n. "
      "With `reference` connected (the signal that drives a "
      "closed "
      "loop, or a generator's where the input is noisy): G = G_yr / G_ur.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapter 7, "
      "doi:10.1002/9781118287422");
  d.reference(
      "J. Schoukens, G. Vandersteen, K. Barbe, R. Pintelon, Nonparametric preprocessing in system identification: a powerful "
      "tool, European Control Conference 2009");
  d.stream_in(input).doc("what excites the plant: one channel per input");
  d.stream_in(output).doc("what the plant answers: one channel per output");
  d.stream_in(reference).optional().doc("what causes the inputs: as many channels as inputs");
  d.message_out(out).record_type("frequency_response").doc("the frequency response, at the end");
  d.parameter("order", std::int64_t{2}).range(0, 8).doc("R of the polynomials; even orders are better value than odd ones");
  d.optional<std::int64_t>("half_width")
      .range(1, 100000)
      .doc("n: a fit takes 2n + 1 lines; default: the smallest that leaves 7 degrees of freedom");
  d.parameter("transient", true).doc("fit the transient too; false only where record and plant begin and end at rest");
  d.parameter("band", std::vector<double>{})
      .unit("Hz")
      .range(0, 1e15)
      .doc("[from, to]: frequencies of the estimate, both included; default: all between zero and the Nyquist frequency");
  d.parameter("step", std::int64_t{1}).range(1, 1e9).doc("from line to line of the estimate; neighbours share data anyway");
  d.parameter("limit", std::int64_t{16'777'216})
      .range(16, 1e9)
      .doc("most samples of a record; about 32 bytes of memory a sample and channel");
}

void LocalPolynomialBlock::configure(const Parameters& p) {
  origin_.settings.order = in_range(p, "order", 0, 8);
  origin_.settings.transient = p.boolean("transient");
  if (p.has("half_width")) half_width_ = in_range(p, "half_width", 1, 100000);
  band_hz_ = p.numbers("band");
  origin_.step = in_range(p, "step", 1, 1'000'000'000);
  limit_ = in_range(p, "limit", 16, 1'000'000'000);
}

/// The lines of the estimate for so many samples; fails where they are too few or too many.
LineRange LocalPolynomialBlock::check_length(std::int64_t samples) const {
  const std::int64_t needed = 2 * (2 * origin_.settings.half_width + 1) + 1;
  if (samples < needed)
    fail("the record has " + counted(samples, "sample") + "; needed: at least " + std::to_string(needed) + ", a fit takes " +
         std::to_string(2 * origin_.settings.half_width + 1) + " lines");
  if (samples > limit_)
    fail("the record has more samples than limit, " + std::to_string(limit_) + "; measure shorter, decimate, or raise limit");
  const auto range = lines_in_band(band_hz_, origin_.sample_rate_hz, samples);
  if (!range) fail(range.error().text);
  if ((range->count() - 1) / origin_.step >= kMostLines)
    fail("the band has " + counted(range->count(), "line") + ", at most " + std::to_string(kMostLines) +
         " are estimated; give a smaller band or a step of " + std::to_string((range->count() - 1) / kMostLines + 1));
  return *range;
}

void LocalPolynomialBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output), &r = f.in(reference);
  if (!u.known || !y.known) return;
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock)
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock +
         "'; a spectrum needs one clock");
  origin_.references = {};
  if (r.known) {
    if (r.clock != u.clock)
      fail("inputs 'input' and 'reference' have the clock domains '" + u.clock + "' and '" + r.clock +
           "'; a spectrum needs one clock");
    if (r.channels != u.channels)
      fail("'reference' has " + counted(r.channels, "channel") + ", 'input' " + std::to_string(u.channels) + "; needed: as many");
    origin_.references = signals_of(r, "reference");
  }
  origin_.inputs = signals_of(u, "input");
  origin_.outputs = signals_of(y, "output");
  origin_.sample_rate_hz = u.rate.hz();
  LocalPolynomial& s = origin_.settings;
  s.half_width = half_width_ ? *half_width_ : usual_half_width(s, u.channels);
  if (s.degrees_of_freedom(u.channels) < 1)
    fail("half_width " + std::to_string(s.half_width) + " gives " + std::to_string(2 * s.half_width + 1) + " lines for " +
         std::to_string(s.unknowns(u.channels)) + " unknowns; needed: at least " +
         std::to_string(s.unknowns(u.channels) / 2 + s.unknowns(u.channels) % 2));
  if (u.length >= 0) check_length(u.length);
}

void LocalPolynomialBlock::advise(const Facts& f, Advice& a) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  const LocalPolynomial& s = origin_.settings;
  const auto nu = static_cast<double>(s.degrees_of_freedom(u.channels));
  const double widening = numerics::confidence_radius(1.0, nu, 0.95) /
                          numerics::confidence_radius(1.0, std::numeric_limits<double>::infinity(), 0.95);
  std::string text = "a fit takes " + std::to_string(2 * s.half_width + 1) + " lines and leaves " + short_number(nu) +
                     " degrees of freedom (95 % radius " + short_number(std::round(100.0 * widening) / 100.0) +
                     " times that of a known variance)";
  if (u.length >= 0) {
    const double seconds = static_cast<double>(u.length) / origin_.sample_rate_hz;
    text += "; lines each " + short_number(1.0 / seconds) + " Hz in " + short_number(seconds) +
            " s: resonances with a 3 dB bandwidth below " + short_number(static_cast<double>(3 * s.half_width) / seconds) +
            " Hz are flattened";
  }
  a.tell(text);
  const auto period = u.note("excitation.period");
  if (!period.empty() && (u.length < 0 || static_cast<double>(u.length) / origin_.sample_rate_hz >= 2.0 * period[0]))
    a.warn("the excitation repeats each " + short_number(period[0]) +
           " s: spectrum.averaging_dft over whole periods tells noise from distortion and has no error of interpolation");
}

void LocalPolynomialBlock::activate(const Activation&) {
  samples_.assign(3, {});
  watches_.assign(3, {});
  for (std::size_t port = 0; port < 3; ++port) {
    samples_[port].resize(signals_of_port(port).names.size());
    watches_[port].resize(samples_[port].size());
  }
}

void LocalPolynomialBlock::reset() { activate({}); }

const Signals& LocalPolynomialBlock::signals_of_port(std::size_t port) const {
  return port == 0 ? origin_.inputs : port == 1 ? origin_.outputs : origin_.references;
}

void LocalPolynomialBlock::process(Io& io) {
  const std::size_t held = samples_[0].front().size();
  if (static_cast<std::int64_t>(held + io.count()) > limit_) check_length(static_cast<std::int64_t>(held + io.count()));
  for (std::size_t port = 0; port < 3; ++port) {
    for (std::size_t c = 0; c < samples_[port].size(); ++c) {
      const auto x = io.read(port_at(port), static_cast<int>(c));
      const std::size_t finite = watches_[port][c].add(x);
      if (finite < x.size())
        fail(std::string(kPorts[port]) + " '" + signals_of_port(port).names[c] + "': sample " + std::to_string(held + finite) +
             " is " + (std::isnan(x[finite]) ? "not a number" : "infinite"));
      samples_[port][c].insert(samples_[port][c].end(), x.begin(), x.end());
    }
  }
}

/// Spectra scaled by 1/N, as those of averaged periods are. The mean is taken off before: it belongs to line 0 alone, and costs
/// the other lines no digits then.
RecordSpectra LocalPolynomialBlock::spectra(std::int64_t samples) const {
  RecordSpectra s;
  s.samples = samples;
  numerics::RealDft dft(samples);
  Eigen::VectorXd x(samples);
  Eigen::MatrixXcd* places[] = {&s.input, &s.output, &s.reference};
  for (std::size_t port = 0; port < 3; ++port) {
    const auto channels = static_cast<Eigen::Index>(samples_[port].size());
    if (channels == 0) continue;
    places[port]->resize(dft.lines(), channels);
    for (Eigen::Index c = 0; c < channels; ++c) {
      x = Eigen::Map<const Eigen::VectorXd>(samples_[port][static_cast<std::size_t>(c)].data(), samples);
      x.array() -= x.mean();
      dft.forward(x, places[port]->col(c));
    }
    *places[port] /= static_cast<double>(samples);
  }
  return s;
}

void LocalPolynomialBlock::look_at(std::size_t port, LocalPolynomialOrigin& from) const {
  for (std::size_t c = 0; c < watches_[port].size(); ++c) {
    const std::string name = std::string(kPorts[port]) + " '" + signals_of_port(port).names[c] + "'";
    if (port != 1 && watches_[port][c].constant()) fail(name + " is constant: it excites nothing");
    if (std::string text = watches_[port][c].clipping(name); !text.empty()) from.warnings.push_back(std::move(text));
  }
}

void LocalPolynomialBlock::finish(Io& io) {
  LocalPolynomialOrigin from = origin_;
  from.samples = static_cast<std::int64_t>(samples_[0].front().size());
  const LineRange range = check_length(from.samples);
  for (std::size_t port = 0; port < 3; ++port) look_at(port, from);
  for (const SampleWatch& watch : watches_[0]) from.input_amplitude.push_back(watch.amplitude());
  std::vector<std::int64_t> lines;
  for (std::int64_t k = range.first; k <= range.last; k += from.step) lines.push_back(k);
  const auto estimate = local_polynomial(spectra(from.samples), lines, from.settings);
  if (!estimate) fail(estimate.error().text);
  from.warnings = local_polynomial_warnings(*estimate, from);
  io.emit(out, local_polynomial_record(*estimate, from));
  for (const std::string& warning : from.warnings) log_warning(warning);
}

void LocalPolynomialBlock::deactivate() {
  samples_.clear();
  watches_.clear();
}

}  // namespace bodeflow::spectrum
