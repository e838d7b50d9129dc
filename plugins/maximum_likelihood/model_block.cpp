#include "model_block.hpp"

#include <algorithm>

#include "model_record.hpp"
#include "model_settings.hpp"
#include "model_warnings.hpp"
#include "records/band.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

/// The lines of a band text.
Spectra lines_in(const std::string& text, const Spectra& spectra) {
  if (text.empty()) return spectra;
  const auto band = records::parse_band(text, spectra.sample_time_s > 0.0 ? 1.0 / spectra.sample_time_s : 0.0);
  if (!band) fail(band.error().text);
  Spectra part = part_within(spectra, band->low_rad_s, band->high_rad_s);
  if (part.lines() == 0) fail("band '" + text + "' holds no line of the response");
  return part;
}

}  // namespace

void ModelBlock::describe(Describe& d) {
  d.id("maximum_likelihood.model")
      .summary("Identifies a rational model of s or z, with delay, from a frequency response by maximum likelihood.")
      .role("identifier");
  d.doc(
      "Minimises sum |Y - G U|^2 / (var Y + |G|^2 var U - 2 Re(conj(G) cov)) from mean spectra with their full covariance (one "
      "input, form errors_in_variables or reference), else from the response and its variance. Several outputs are fitted "
      "together "
      "with one denominator and one delay; the record `model` is that of the first one named. Says how sure it is of "
      "coefficients, poles, "
      "zeros and delay, and whether the noise explains what is left. Assumes noise that is independent from line to line; the "
      "last response that "
      "arrives is taken.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapters 9 to 12, "
      "doi:10.1002/9781118287422");
  d.reference(
      "C. K. Sanathanan, J. Koerner, Transfer function synthesis as a ratio of two complex polynomials, 1963, "
      "doi:10.1109/TAC.1963.1105517");
  d.message_in(response).record_type("frequency_response").doc("one column of it: one input, one or several outputs");
  d.message_out(model).record_type("model").doc("at the end");
  d.message_out(order_scan).record_type("order_scan").doc("cost and criteria over the order, where the order is sought");
  d.message_out(residual).record_type("residual").doc("what the model leaves, line by line and by bands");
  d.parameter("input", "").doc("name of the input, where the response has several");
  d.parameter("outputs", std::vector<std::string>{})
      .doc("names of the outputs that are fitted together, the modelled one first; default: all");
  d.parameter("band", "").doc("frequencies that are fitted, as 1 Hz:50 Hz or 0:0.625 [rad/sample]; default: all lines");
  d.parameter("bands", std::vector<double>{})
      .unit("Hz")
      .range(0, 1e15)
      .doc("edges of the bands of the record `residual`; default: six bands with as many lines each");
  describe_settings(d);
}

void ModelBlock::configure(const Parameters& p) {
  settings_ = read_settings(p);
  input_ = p.text("input");
  outputs_ = p.texts("outputs");
  band_ = p.text("band");
  bands_hz_ = p.numbers("bands");
  if (bands_hz_.size() == 1 || !std::is_sorted(bands_hz_.begin(), bands_hz_.end()))
    fail("bands: allowed: two edges or more that rise");
}

void ModelBlock::receive(int, const RecordView& record, Io&) {
  auto measured = read_measured(record, input_, outputs_);
  if (!measured) fail(measured.error().text);
  measured_ = std::move(*measured);
}

void ModelBlock::finish(Io& io) {
  if (!measured_) fail("no frequency response arrived");
  Settings settings = settings_;
  if (!measured_->has_variance && settings.weighting == Weighting::variance) settings.weighting = Weighting::relative;
  const Spectra spectra = lines_in(band_, measured_->spectra);
  const auto found = identify(spectra, settings);
  if (!found) fail(found.error().text);
  const std::vector<std::string> warnings = model_warnings(*found, *measured_);
  io.emit(model, model_record(*found, *measured_, settings, warnings));
  if (found->scan) io.emit(order_scan, order_scan_record(*found->scan));
  io.emit(residual, residual_record(*found, *measured_, spectra, bands_hz_));
  for (const std::string& warning : warnings) log_warning(warning);
}

void ModelBlock::reset() { measured_.reset(); }

}  // namespace bodeflow::maximum_likelihood
