#include "fir_block.hpp"

#include <cmath>
#include <span>

#include "filter_record.hpp"
#include "iir_parameters.hpp"
#include "notes.hpp"
#include "records/signals.hpp"
#include "section_block.hpp"

namespace bodeflow::filters {
namespace {

using numerics::Pass;
using records::short_number;

numerics::Window read_window(const std::string& name) {
  if (name == "rectangular") return numerics::Window::rectangular;
  if (name == "hann") return numerics::Window::hann;
  if (name == "blackman") return numerics::Window::blackman;
  return name == "kaiser" ? numerics::Window::kaiser : numerics::Window::hamming;
}

void require_count(const char* name, std::size_t found, std::size_t needed, const char* of) {
  if (found == needed) return;
  fail(std::string(name) + " has " + std::to_string(found) + " values; allowed: " + std::to_string(needed) + ", " + of);
}

bool symmetric(const Eigen::VectorXd& taps) { return taps == taps.reverse(); }

}  // namespace

void Fir::describe(Describe& d) {
  d.id("filters.fir").summary("Finite impulse response: by window, by least squares, or as given.").realtime_safe().in_place();
  d.doc(
      "y[n] = sum_j h[j] x[n - j]. Filters by window and by least squares have linear phase, a delay of (taps - 1) / 2 samples "
      "at "
      "every frequency. window: the ideal response cut at the edges, where the gain is about 1/2; gain 1 in the pass band. "
      "least_squares: the least weighted square of the error over the bands, nothing asked for between them. given: "
      "`coefficients` as they are.");
  d.reference("T. W. Parks, C. S. Burrus, Digital Filter Design, 1987");
  d.cost_ns(5);
  d.parameter("method", "window").choices({"window", "least_squares", "given"}).doc("where the coefficients come from");
  d.parameter("taps", std::int64_t{65}).range(1, numerics::kMostTaps).doc("coefficients; odd where the Nyquist frequency passes");
  d.parameter("pass", "low_pass").choices({"low_pass", "high_pass", "band_pass", "band_stop"}).doc("of a filter by window");
  d.parameter("edges", std::vector<double>{}).unit("Hz").doc("of a filter by window: one, two rising ones of band filters");
  d.parameter("window", "hamming").choices({"rectangular", "hann", "hamming", "blackman", "kaiser"}).doc("of a filter by window");
  d.parameter("beta", 8.0).unit("1").range(0, 50).doc("of the Kaiser window: 8 stops by about 80 dB");
  d.optional<Matrix>("bands").doc("of least squares: one row a band, lower and upper edge in Hz");
  d.optional<Matrix>("gains").doc("of least squares: one row a band, wanted gain at the lower and the upper edge");
  d.parameter("weights", std::vector<double>{}).unit("1").doc("of least squares: one a band; 1 without");
  d.parameter("coefficients", std::vector<double>{}).unit("1").doc("h, of method given");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
  d.message_out(filter).record_type("filter").doc("at the end: impulse and frequency response");
}

void Fir::configure(const Parameters& p) {
  method_ = p.text("method");
  window_.taps = static_cast<int>(p.integer("taps"));
  window_.shape = read_window(p.text("window"));
  window_.beta = p.number("beta");
  const std::string& pass = p.text("pass");
  window_.pass = pass == "high_pass"   ? Pass::high
                 : pass == "band_pass" ? Pass::band
                 : pass == "band_stop" ? Pass::stop
                                       : Pass::low;
  edges_hz_ = p.numbers("edges");
  const std::vector<double>& h = p.numbers("coefficients");
  given_ = Eigen::Map<const Eigen::VectorXd>(h.data(), static_cast<Eigen::Index>(h.size()));
  if (method_ == "window") {
    const bool band = window_.pass == Pass::band || window_.pass == Pass::stop;
    require_count("edges", edges_hz_.size(), band ? 2 : 1, ("the edges of a " + pass + " filter").c_str());
  } else if (method_ == "least_squares") {
    configure_bands(p);
  } else if (given_.size() == 0 || given_.size() > numerics::kMostTaps || !given_.allFinite()) {
    fail("coefficients has " + std::to_string(given_.size()) + " values; allowed: 1 to " + std::to_string(numerics::kMostTaps) +
         " finite ones");
  }
}

void Fir::configure_bands(const Parameters& p) {
  if (!p.has("bands") || !p.has("gains")) fail("method least_squares needs bands and gains");
  const Matrix bands = p.matrix("bands"), gains = p.matrix("gains");
  std::vector<double> weights = p.numbers("weights");
  if (weights.empty()) weights.assign(bands.rows, 1.0);
  if (bands.columns != 2 || gains.columns != 2) fail("bands and gains need rows of two values");
  require_count("gains", gains.rows, bands.rows, "one row a band");
  require_count("weights", weights.size(), bands.rows, "one a band");
  for (std::size_t i = 0; i < bands.rows; ++i) {
    bands_hz_.push_back({bands(i, 0), bands(i, 1), gains(i, 0), gains(i, 1), weights[i]});
  }
}

Eigen::VectorXd Fir::design(double rate_hz) const {
  const double nyquist = 0.5 * rate_hz;
  if (method_ == "given") return given_;
  if (method_ == "window") {
    numerics::WindowDesign d = window_;
    for (std::size_t i = 0; i < edges_hz_.size(); ++i) {
      require_below_nyquist("edges", edges_hz_[i], rate_hz);
      d.edges[i] = edges_hz_[i] / nyquist;
    }
    return value_or_fail(numerics::fir_by_window(d), "filter");
  }
  std::vector<numerics::Band> bands = bands_hz_;
  for (numerics::Band& b : bands) {
    b.low /= nyquist;
    b.high /= nyquist;
  }
  return value_or_fail(numerics::fir_by_least_squares(window_.taps, bands), "bands");
}

void Fir::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  rate_hz_ = x.rate.hz();
  channels_ = x.channels;
  taps_ = design(rate_hz_);
  f.out(out).notes = filtered(x.notes, static_cast<double>(taps_.size()) / rate_hz_);
}

void Fir::advise(const Facts& f, Advice& a) {
  if (!f.in(in).known || !symmetric(taps_)) return;
  const double delay = 0.5 * static_cast<double>(taps_.size() - 1);
  a.tell(std::to_string(taps_.size()) + " taps of linear phase: a delay of " + short_number(delay) + " samples (" +
         short_number(delay / rate_hz_, 3) + " s) at every frequency");
}

void Fir::activate(const Activation& a) {
  vector_level_ = a.vector_level;
  const std::span<const double> h(taps_.data(), static_cast<std::size_t>(taps_.size()));
  filters_.assign(static_cast<std::size_t>(channels_), FirFilter(h, static_cast<std::size_t>(a.max_count)));
}

void Fir::process(Io& io) {
  for (std::size_t c = 0; c < filters_.size(); ++c) {
    filters_[c].run(io.read(in, static_cast<int>(c)), io.write(out, static_cast<int>(c)), vector_level_);
  }
}

void Fir::finish(Io& io) { io.emit(filter, fir_record(method_ == "given" ? "given taps" : "linear phase", rate_hz_, taps_)); }

void Fir::reset() {
  for (FirFilter& one : filters_) one.reset();
}

}  // namespace bodeflow::filters
