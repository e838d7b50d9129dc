#include "motor_block.hpp"

#include <algorithm>
#include <cmath>

#include "excited_lines.hpp"
#include "motor_record.hpp"
#include "records/band.hpp"
#include "records/signals.hpp"

namespace bodeflow::frisch {
namespace {

template <class T>
T or_fail(Expected<T> value, const std::string& where = "") {
  if (!value) fail(where + value.error().text);
  return std::move(*value);
}

Method method_of(const std::string& name) {
  if (name == "frisch") return Method::frisch;
  return name == "none" ? Method::none : Method::maximum_likelihood;
}

void describe_streams(Describe& d) {
  d.optional<std::int64_t>("period").range(3, 1e8).doc("samples in one period of the excitation; needed for the streams");
  d.parameter("skip", std::int64_t{0}).range(0, 1e9).doc("periods at the start of the streams that hold the transient");
  d.optional<std::int64_t>("step").range(1, 1e8).doc(
      "samples from window to window of the streams, for frisch and none; default: the period; half of it is worth most");
  d.optional<std::int64_t>("lines.first").range(1, 1e8).doc("first line of the streams (multiple of rate / period)");
  d.optional<std::int64_t>("lines.last").range(1, 1e8).doc("last line; default: the last below the Nyquist frequency");
  d.parameter("lines.step", std::int64_t{1})
      .range(1, 1e8)
      .doc("from line to line; without first and last: the lines that the input excites");
}

}  // namespace

void Motor::describe(Describe& d) {
  d.id("frisch.motor").summary("Identifies an induction motor at standstill from noisy voltage and current.").role("identifier");
  d.doc(
      "G(s) = (s + alpha)/sigma / (s^2 + s (gamma + alpha) + alpha (gamma - alpha Lm_beta)) from stator voltage to stator "
      "current "
      "of one axis. Every record, and the pair of streams, is a band with noise of its own; all bands are fitted together. "
      "maximum_likelihood pools the scatter between periods over the lines of a band and minimises sum |Y - G U|^2 / (var Y + "
      "|G|^2 var U - 2 Re(conj(G) cov)). frisch takes the variances that the Frisch scheme finds, in two passes, corrects the "
      "spectra and fits by least squares; none does the same without correction. What the terminals do not tell (Lm, Lr, Rr) "
      "is given under Ls = Lr.");
  d.reference(
      "P. Castaldi, M. Montanari, A. Tilli, Induction motor model identification via frequency-domain Frisch scheme, IFAC 2002");
  d.reference(
      "J. Schoukens, R. Pintelon, G. Vandersteen, P. Guillaume, Frequency-domain system identification using non-parametric "
      "noise "
      "models, Automatica 33 (1997) 1073");
  d.stream_in(input).optional().doc("stator voltage, one axis");
  d.stream_in(output).optional().doc("stator current of that axis");
  d.message_in(response)
      .optional()
      .record_type("frequency_response")
      .doc("measured responses with mean spectra: one record a band");
  d.message_in(matrix)
      .optional()
      .record_type("spectral_matrix")
      .doc("spectral matrices: one record a band; frisch and none prefer them");
  d.message_out(model).record_type("model").doc("gamma, alpha, Lm_beta, sigma with covariance");
  d.message_out(identifiable).record_type("parameters").doc("Rs, Ls, Lr/Rr, sigma: what the terminals tell");
  d.message_out(physical).record_type("parameters").doc("Rs, Rr, Ls, Lr, Lm under the assumption Ls = Lr");
  d.message_out(fitted).record_type("frequency_response").doc("the response that was fitted, the hold taken off");
  d.parameter("method", "maximum_likelihood")
      .choices({"maximum_likelihood", "frisch", "none"})
      .doc("maximum_likelihood is recommended; frisch is the paper's, none its comparison without the scheme");
  d.parameter("form", "output")
      .choices({"output", "input"})
      .doc("of frisch and none, equation (10): output: (yy - its noise)/uy, input: yu/(uu - its noise)");
  d.parameter("outliers", 0.08)
      .unit("1")
      .range(0.0, 0.9)
      .doc("of frisch: fraction of the lines, those nearest to singular, that the second pass leaves out");
  d.parameter("correlated_noise", true)
      .doc("of maximum_likelihood: false takes the noises of voltage and current as independent");
  d.parameter("hold", 0.0)
      .unit("s")
      .range(0.0, 10.0)
      .doc("a step of the staircase whose samples the input is (zero-order hold); 0: the input is continuous in time");
  d.parameter("delay", 0.0).unit("s").range(-10.0, 10.0).doc("known delay of the output against the input, taken off the data");
  d.parameter("input_is", "terminal_voltage")
      .choices({"terminal_voltage", "period_mean", "command"})
      .doc("which voltage the input is: measured at the terminals, its mean over a PWM period, or the command to the inverter");
  d.parameter("band", "").doc("lines that are used, such as `1 Hz:50 Hz`; default: all");
  describe_streams(d);
}

void Motor::configure(const Parameters& p) {
  settings_.method = method_of(p.text("method"));
  settings_.form = p.text("form") == "input" ? ResponseForm::input : ResponseForm::output;
  settings_.outliers = p.number("outliers");
  settings_.correlated_noise = p.boolean("correlated_noise");
  settings_.sampling = {p.number("hold"), p.number("delay")};
  input_is_ = p.text("input_is");
  band_ = p.text("band");
  configure_lines(p);
}

void Motor::configure_lines(const Parameters& p) {
  period_ = p.has("period") ? p.integer("period") : 0;
  skip_ = p.integer("skip");
  step_ = p.has("step") ? p.integer("step") : period_;
  lines_.clear();
  if (!p.has("lines.first") && !p.has("lines.last") && !p.given("lines.step")) return;
  if (period_ == 0) fail("lines: they belong to the streams and need `period`");
  const Eigen::Index highest = (period_ - 1) / 2, first = p.has("lines.first") ? p.integer("lines.first") : 1,
                     last = p.has("lines.last") ? p.integer("lines.last") : highest;
  if (first > last || last > highest) {
    fail("lines: from " + std::to_string(first) + " to " + std::to_string(last) + "; allowed: rising, at most " +
         std::to_string(highest) + " with a period of " + std::to_string(period_));
  }
  const Eigen::Index step = p.integer("lines.step");
  if (first < 1 || step < 1) fail("lines: first and step are at least 1");
  for (Eigen::Index k = first; k <= last; k += step) lines_.push_back(k);
}

void Motor::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  for (const StreamFacts* s : {&u, &y}) {
    if (s->channels != 1) {
      fail("input '" + std::string(s == &u ? "input" : "output") + "' has " + std::to_string(s->channels) +
           " channels; needed: one, the axis that is driven");
    }
  }
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock) {
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock +
         "'; a spectrum needs one clock");
  }
  if (period_ == 0) fail("period is needed for the streams: samples in one period of the excitation");
  sample_rate_hz_ = u.rate.hz();
  const records::Signals in = records::signals_of(u, "input"), out = records::signals_of(y, "output");
  input_name_ = in.names.front();
  input_unit_ = in.units.front();
  output_name_ = out.names.front();
  output_unit_ = out.units.front();
}

void Motor::activate(const Activation&) { reset(); }

void Motor::keep(Io& io, In<double> port, std::vector<double>& to) const {
  const auto x = io.read(port, 0);
  const auto bad = std::find_if(x.begin(), x.end(), [](double value) { return !std::isfinite(value); });
  if (bad != x.end()) {
    fail(std::string(port.name) + ": sample " + std::to_string(io.position() + static_cast<std::uint64_t>(bad - x.begin())) +
         " is " + (std::isnan(*bad) ? "not a number" : "infinite"));
  }
  to.insert(to.end(), x.begin(), x.end());
}

void Motor::process(Io& io) {
  if (!io.connected(input) && !io.connected(output)) return;
  if (!io.connected(input) || !io.connected(output)) fail("connect both streams, input and output, or neither");
  keep(io, input, input_samples_);
  keep(io, output, output_samples_);
}

void Motor::receive(int port, const RecordView& record, Io&) {
  auto& bands = port == response.index ? responses_ : matrices_;
  Expected<Band> band = port == response.index ? band_of_response(record) : band_of_matrix(record);
  bands.push_back(or_fail(
      std::move(band), std::string(port == response.index ? "response " : "matrix ") + std::to_string(bands.size() + 1) + ": "));
}

Band Motor::streamed_band() const {
  const auto skipped = static_cast<std::size_t>(skip_ * period_);
  if (input_samples_.size() < skipped + 2 * static_cast<std::size_t>(period_)) {
    fail(std::to_string(input_samples_.size()) + " samples; needed: " + std::to_string(skip_) +
         " skipped periods and 2 more of " + std::to_string(period_));
  }
  const auto rest = [skipped](const std::vector<double>& all) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(all.data() + skipped, static_cast<Eigen::Index>(all.size() - skipped)));
  };
  const Eigen::VectorXd u = rest(input_samples_), y = rest(output_samples_);
  const auto lines = lines_.empty() ? or_fail(excited_lines(u, period_), "input: ") : lines_;
  Band band = or_fail(band_of_samples(u, y, period_, step_, lines, sample_rate_hz_));
  band.input_name = input_name_;
  band.output_name = output_name_;
  band.input_unit = input_unit_;
  band.output_unit = output_unit_;
  return band;
}

std::vector<Band> Motor::measured_bands() const {
  const bool likelihood = settings_.method == Method::maximum_likelihood;
  const auto &first = likelihood ? responses_ : matrices_, &second = likelihood ? matrices_ : responses_;
  std::vector<Band> bands = first.empty() ? second : first;
  if (!input_samples_.empty()) bands.push_back(streamed_band());
  if (bands.empty()) fail("nothing was measured: connect `response`, `matrix`, or the streams `input` and `output`");
  return band_.empty() ? bands : parts_of(bands);
}

/// The lines of all bands that lie in the parameter `band`.
std::vector<Band> Motor::parts_of(const std::vector<Band>& bands) const {
  std::vector<Band> parts;
  std::string reason;
  for (const Band& band : bands) {
    // Ends with units need no sample rate, and may lie beyond half that of one of the bands.
    auto limits = records::parse_band(band_, 0.0);
    if (!limits) limits = records::parse_band(band_, band.sample_rate_hz);
    if (!limits) fail(limits.error().text);
    auto part = part_of(band, limits->low_rad_s, limits->high_rad_s);
    if (part) parts.push_back(std::move(*part));
    if (!part) reason = part.error().text;
  }
  if (parts.empty()) fail(reason);
  return parts;
}

void Motor::finish(Io& io) {
  MotorContext context{input_is_, measured_bands(), settings_};
  const MotorEstimate estimate = or_fail(estimate_motor(context.bands, settings_));
  io.emit(model, model_record(estimate, context));
  io.emit(identifiable, identifiable_record(estimate));
  io.emit(physical, equal_inductance_record(estimate));
  io.emit(fitted, fitted_response_record(estimate, context));
  for (const std::string& warning : motor_warnings(estimate, context)) log_warning(warning);
}

void Motor::reset() {
  input_samples_.clear();
  output_samples_.clear();
  responses_.clear();
  matrices_.clear();
}

}  // namespace bodeflow::frisch
