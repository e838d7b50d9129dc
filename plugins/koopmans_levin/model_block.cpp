#include "model_block.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>
#include <cmath>

#include "model_record.hpp"
#include "model_warnings.hpp"
#include "records/band.hpp"
#include "records/checksum.hpp"

namespace bodeflow::koopmans_levin {

namespace {

constexpr std::int64_t kHighestOrder = 64;
constexpr std::int64_t kMostSamples = std::int64_t{1} << 30;
constexpr std::int64_t kMostLags = 10'000;
constexpr double kLeastRatio = 1e-12;  // beyond it or its inverse one of the noises is lost in rounding

std::optional<double> number_or_auto(const std::string& name, const std::string& text) {
  if (text == "auto") return {};
  const auto value = convert(text, "1");
  if (!value) fail(name + ": '" + text + "' is not a number; allowed: a number, or auto");
  return *value;
}

std::optional<Eigen::Index> read_order(const std::string& text) {
  const auto value = number_or_auto("order", text);
  if (!value) return {};
  if (!(*value >= 1.0 && *value <= static_cast<double>(kHighestOrder)) || *value != std::floor(*value))
    fail("order: '" + text + "'; allowed: 1 to " + std::to_string(kHighestOrder) + ", or auto");
  return static_cast<Eigen::Index>(*value);
}

std::optional<double> read_ratio(const std::string& text) {
  const auto value = number_or_auto("ratio", text);
  if (value && !(*value >= kLeastRatio && *value <= 1.0 / kLeastRatio))
    fail("ratio: '" + text + "'; allowed: 1e-12 to 1e12, or auto");
  return value;
}

/// The lines of a band text; nothing for all of them.
std::optional<Band> lines_in(const std::string& text, double rate_hz, std::int64_t samples) {
  const auto band = records::parse_band(text, rate_hz);
  if (!band) fail(band.error().text);
  const double limit = 3.14159265358979323846;
  const auto lines = band_of(band->low_rad_s / rate_hz, std::min(band->high_rad_s / rate_hz, limit), samples);
  if (!lines) fail("band '" + text + "': " + lines.error().text);
  const bool all = lines->first == 0 && lines->last == samples / 2;
  return all ? std::nullopt : std::optional(*lines);
}

}  // namespace

void ModelBlock::describe(Describe& d) {
  d.id("koopmans_levin.model")
      .summary("Identifies a discrete-time model from one record whose input and output both carry white noise.")
      .role("identifier")
      .cost_ns(2);
  d.doc(
      "A(z^-1) y = B(z^-1) u from any input, periodic or not: the ends of the record are part of the model. The ratio of output "
      "to input noise variance must be known, measured or estimated; where the data do not determine it, the block says so and "
      "gives no model, unless `fallback_ratio` is given (attribute ratio_determined). All samples are collected, 16 bytes each, "
      "about 70 bytes each at the end; `max_samples` limits them. Biased by coloured noise, by noise common to both "
      "signals, by a wrong ratio; a model of too low an order fits what is strong.");
  d.reference(
      "U. Soverini, G. Catania, FRF parameter identification with arbitrary input sequence from noisy input-output measurements");
  d.reference(
      "K. V. Fernando, H. Nicholson, Identification of linear systems with input and output noise: the Koopmans-Levin method, "
      "1985, doi:10.1049/ip-d.1985.0007");
  d.stream_in(input).doc("one channel, with its noise");
  d.stream_in(output).doc("one channel, with its noise");
  d.message_out(model).record_type("model").doc("at the end");
  d.message_out(order_scan).record_type("order_scan").doc("noise over order, where the order is sought");
  d.message_out(whiteness).record_type("whiteness").doc("power of the equation errors by bands, 1 as white noises make it");
  d.parameter("order", "auto").doc("number of poles, or auto: the order from which the noise falls no further");
  d.parameter("highest_order", std::int64_t{8}).range(2, kHighestOrder).doc("of the search for the order");
  d.parameter("ratio", "auto")
      .doc(
          "variance of the output noise over that of the input noise: a number, or auto: by covariance matching, or from "
          "output_noise or noise_band");
  d.optional<double>("output_noise").unit("").above(0).doc("variance of the output noise where it was measured, for ratio: auto");
  d.parameter("output_noise_std", 0.0).unit("").range(0, 1e300).doc("standard deviation of that variance");
  d.parameter("noise_band", "")
      .doc("band where the response is nearly zero: the output there is taken for noise, for ratio: auto");
  d.optional<double>("fallback_ratio").unit("1").above(0).doc("ratio of the model where the data determine none");
  d.optional<std::int64_t>("lags")
      .range(1, kMostLags)
      .doc("of covariance matching; default: the order, on a band 1.5 periods of its width, at least 16");
  d.parameter("band", "")
      .doc("frequencies that are fitted, as 0:0.625 [rad/sample] or 1 Hz:50 Hz; ends are taken to the nearest line");
  d.parameter("transient", true).doc("model the ends of the record; false is right for whole periods in steady state");
  d.parameter("refine", "none")
      .choices({"none", "maximum_likelihood"})
      .doc("maximum likelihood from the estimate on: scatters less");
  d.parameter("noise_matrix", "exact")
      .choices({"exact", "identity"})
      .doc("identity: as the paper prints it, wrong on a band; for comparison");
  d.parameter("route", "frequency_domain")
      .choices({"frequency_domain", "time_domain"})
      .doc("time_domain: the classical equations, the same numbers over the full range");
  d.optional<std::int64_t>("samples").range(1, kMostSamples).doc("takes only the first so many; default: all");
  d.parameter("max_samples", std::int64_t{10'000'000}).range(10, kMostSamples).doc("more samples are refused");
}

void ModelBlock::configure(const Parameters& p) {
  Settings s;
  s.order = read_order(p.text("order"));
  s.highest_order = p.integer("highest_order");
  s.ratio = read_ratio(p.text("ratio"));
  if (p.has("output_noise")) s.output_noise = p.number("output_noise");
  s.output_noise_std = p.number("output_noise_std");
  if (p.has("fallback_ratio")) s.fallback_ratio = p.number("fallback_ratio");
  if (p.has("lags")) s.lags = p.integer("lags");
  if (s.lags && (*s.lags < 1 || *s.lags > kMostLags))
    fail("lags " + std::to_string(*s.lags) + "; allowed: 1 to " + std::to_string(kMostLags));
  s.transient = p.boolean("transient");
  s.refine = p.text("refine") == "maximum_likelihood";
  s.noise_matrix = p.text("noise_matrix") == "identity" ? NoiseMatrix::identity : NoiseMatrix::exact;
  s.route = p.text("route") == "time_domain" ? Route::time_domain : Route::frequency_domain;
  band_ = p.text("band");
  noise_band_ = p.text("noise_band");
  most_samples_ = p.integer("max_samples");
  wanted_ = p.has("samples") ? p.integer("samples") : 0;
  if (wanted_ < 0 || wanted_ > kMostSamples)
    fail("samples " + std::to_string(wanted_) + "; allowed: 1 to " + std::to_string(kMostSamples));
  const bool measured = s.output_noise || !noise_band_.empty();
  if (s.ratio && measured) fail("ratio is given, so output_noise and noise_band have no use: leave them out, or set ratio: auto");
  if (s.output_noise && !noise_band_.empty())
    fail("output_noise and noise_band both state the output noise; allowed: one of them");
  if (s.refine && !s.transient) fail("refine: maximum_likelihood needs transient: true");
  settings_ = s;
}

void ModelBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  for (const StreamFacts* s : {&u, &y}) {
    if (s->channels != 1)
      fail(std::string("the ") + (s == &u ? "input" : "output") + " has " + std::to_string(s->channels) +
           " channels; allowed: one");
    if (wanted_ == 0 && s->length > most_samples_)
      fail(std::to_string(s->length) + " samples are more than max_samples, " + std::to_string(most_samples_));
  }
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock)
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock + "'; a model needs one clock");
  rate_hz_ = u.rate.hz();
  input_signal_ = records::signals_of(u, "input");
  output_signal_ = records::signals_of(y, "output");
  for (const std::string* band : {&band_, &noise_band_}) {
    const auto parsed = records::parse_band(*band, rate_hz_);
    if (!parsed) fail(parsed.error().text);
  }
  const auto period = u.note("excitation.period");
  period_ = period.empty() ? 0.0 : period[0] * rate_hz_;
}

void ModelBlock::activate(const Activation&) { reset(); }

void ModelBlock::collect(std::span<const double> samples, const char* name, std::vector<double>& into) const {
  if (wanted_ > 0) samples = samples.first(std::min(samples.size(), static_cast<std::size_t>(wanted_) - into.size()));
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (std::isfinite(samples[n])) continue;
    fail(std::string(name) + " '" + (name == std::string("input") ? input_signal_ : output_signal_).names[0] + "': sample " +
         std::to_string(into.size() + n) + " is " + (std::isnan(samples[n]) ? "not a number" : "infinite"));
  }
  if (static_cast<std::int64_t>(into.size() + samples.size()) > most_samples_)
    fail("the records have more than max_samples, " + std::to_string(most_samples_) + " samples");
  into.insert(into.end(), samples.begin(), samples.end());
}

void ModelBlock::process(Io& io) {
  collect(io.read(input, 0), "input", u_);
  collect(io.read(output, 0), "output", y_);
}

Settings ModelBlock::settings_for(std::int64_t samples) const {
  Settings s = settings_;
  if (!band_.empty()) s.band = lines_in(band_, rate_hz_, samples);
  if (!noise_band_.empty()) s.noise_band = lines_in(noise_band_, rate_hz_, samples).value_or(Band{0, samples / 2});
  return s;
}

void ModelBlock::finish(Io& io) {
  if (u_.empty()) fail("no samples arrived");
  const auto size = static_cast<Eigen::Index>(u_.size());
  if (size < wanted_) fail("only " + records::counted(size, "sample") + " arrived; samples asks for " + std::to_string(wanted_));
  const Eigen::Map<const Eigen::VectorXd> u(u_.data(), size), y(y_.data(), size);
  const Settings settings = settings_for(size);
  const auto found = identify(u, y, settings);
  if (!found) fail(found.error().text);
  records::Checksum checksum;
  checksum.add(u_);
  checksum.add(y_);
  const double periods = period_ > 0.0 ? static_cast<double>(size) / period_ : 0.5;
  Origin from{rate_hz_, input_signal_, output_signal_, u.cwiseAbs().maxCoeff(), checksum.text(), {}};
  from.warnings = model_warnings(*found, settings, rate_hz_, std::abs(periods - std::round(periods)) < 1e-9);
  const auto record = model_record(*found, from);
  if (!record) fail(record.error().text);
  io.emit(model, *record);
  if (found->scan) io.emit(order_scan, order_scan_record(*found->scan));
  if (found->whiteness) io.emit(whiteness, whiteness_record(*found->whiteness, rate_hz_));
  for (const std::string& warning : from.warnings) log_warning(warning);
}

void ModelBlock::reset() {
  u_.clear();
  y_.clear();
}

}  // namespace bodeflow::koopmans_levin
