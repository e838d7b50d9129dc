#include "multi_band_block.hpp"

#include <algorithm>
#include <numbers>

#include "block_settings.hpp"
#include "model_record.hpp"
#include "multi_band_record.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

std::vector<double> angular(const std::vector<double>& hertz) {
  std::vector<double> omega = hertz;
  for (double& f : omega) f *= 2.0 * std::numbers::pi;
  return omega;
}

}  // namespace

void MultiBandBlock::describe(Describe& d) {
  d.id("sanathanan_koerner.multi_band")
      .summary("Identifies a sum of rational models, one a band, each fitted to what the others leave.")
      .role("identifier");
  d.doc(
      "Jue's procedure without a hand on it: the best fit in one band as bound; cuts where the response is flattest; the order "
      "of "
      "each "
      "band; lower bands in turns until they settle, then the next; all again with the final orders; a record `log` of the "
      "rounds. "
      "Where one band is better that is the model, and a warning says so. Needs more poles than sanathanan_koerner.model for the "
      "same error, which is what to use unless you want this method.");
  d.reference("D. A. Jue, Frequency domain system identification with a rational, multi-band, curve-fitting approach, 1998");
  d.reference(
      "D. S. Bayard, High-order wide-band frequency domain identification using composite curve fitting, 1992, "
      "doi:10.23919/ACC.1992.4792699");
  d.message_in(response)
      .record_type("frequency_response")
      .doc("any number of inputs and outputs; the last that arrives is taken");
  d.message_out(model).record_type("model").doc("at the end");
  d.message_out(log).record_type("band_log").doc("the rounds: iterations of each band and the error of the sum");
  d.message_out(residual).record_type("residual").doc("what the model leaves, line by line");
  d.parameter("cuts", std::vector<double>{}).unit("Hz").range(0, 1e15).doc("between the bands; default: sought");
  d.parameter("orders", std::vector<std::int64_t>{}).range(1, 1000).doc("poles of each band; default: sought");
  d.parameter("prewarps", std::vector<double>{}).unit("Hz").range(1e-15, 1e15).doc("of each band; default: sought");
  d.parameter("most_bands", std::int64_t{3}).range(2, 10).doc("where the cuts are sought");
  d.parameter("highest_order", std::int64_t{20})
      .range(1, 1000)
      .doc("of a band and of the fit in one band, where they are sought");
  d.parameter("rounds", std::int64_t{25}).range(1, 1000).doc("most passes over all bands; the best is kept");
  d.parameter("tolerance", 1e-3).unit("1").range(0, 1).doc("relative change of the error that counts as settled");
  d.parameter("basis", "orthonormal").choices({"orthonormal", "monomial"}).doc("monomial: powers of 1/z as Jue prints them");
  d.parameter("iteration_weight", "denominator")
      .choices({"denominator", "square_root"})
      .doc("of an iterate: 1/|d| of the one before, or Jue's 1/sqrt|d|");
  describe_lines(d);
  d.parameter("weight_below", 0.1).unit("1").range(0, 1).doc("of the lines below a band");
  d.parameter("weight_above", 1e-4).unit("1").range(0, 1).doc("of the lines above a band");
}

void MultiBandBlock::configure(const Parameters& p) {
  MultiBandSettings s;
  s.cuts_rad_s = angular(p.numbers("cuts"));
  for (const std::int64_t order : p.integers("orders")) s.orders.push_back(order);
  s.prewarps_rad_s = angular(p.numbers("prewarps"));
  s.most_bands = p.integer("most_bands");
  s.highest_order = p.integer("highest_order");
  s.rounds = static_cast<int>(p.integer("rounds"));
  s.tolerance = p.number("tolerance");
  s.monomial = p.text("basis") == "monomial";
  s.weight_exponent = p.text("iteration_weight") == "square_root" ? 0.5 : 1.0;
  s.below = p.number("weight_below");
  s.above = p.number("weight_above");
  settings_ = s;
  selection_ = {p.texts("inputs"), p.texts("outputs"), p.text("band"), read_weighting(p), {}};
}

void MultiBandBlock::receive(int, const RecordView& record, Io&) {
  auto measured = read_measured(record, selection_);
  if (!measured) fail(measured.error().text);
  measured_ = std::move(*measured);
}

void MultiBandBlock::finish(Io& io) {
  if (!measured_) fail("no frequency response arrived");
  const auto found = multi_band_fit(measured_->data, settings_);
  if (!found) fail(found.error().text);
  const std::vector<std::string> warnings = multi_band_warnings(*found, settings_);
  const auto record = multi_band_record(*found, *measured_, warnings);
  if (!record) fail(record.error().text);
  io.emit(model, *record);
  io.emit(log, band_log_record(*found));
  io.emit(residual, band_residual_record(*found, *measured_));
  for (const std::string& warning : warnings) log_warning(warning);
}

void MultiBandBlock::reset() { measured_.reset(); }

}  // namespace bodeflow::sanathanan_koerner
