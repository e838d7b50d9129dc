#include "monte_carlo_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "monte_carlo.hpp"
#include "records/signals.hpp"

namespace bodeflow::validation {
namespace {

std::string listed(const std::vector<Quantity>& quantities) {
  std::string text;
  for (const Quantity& q : quantities) text += (text.empty() ? "" : ", ") + q.name;
  return text;
}

/// A list has an entry for each quantity, or is empty.
template <class T>
void require_fit(const char* parameter, const std::vector<T>& list, const std::vector<Quantity>& quantities) {
  if (list.empty() || list.size() == quantities.size()) return;
  fail(std::string(parameter) + " has " + records::counted(static_cast<std::int64_t>(list.size()), "value") + " for " +
       records::counted(static_cast<std::int64_t>(quantities.size()), "number") + ": " + listed(quantities));
}

bool is_seed(const std::string& axis) { return axis == "seed" || (axis.size() > 5 && axis.ends_with(".seed")); }

/// The seeds of the runs; refuses what else a sweep may hold.
std::vector<double> seeds_of(const RecordView& sweep) {
  constexpr std::string_view kAxis = "axis.";
  std::vector<std::string> axes;
  for (const auto& array : sweep.arrays())
    if (array.name.starts_with(kAxis)) axes.emplace_back(array.name.substr(kAxis.size()));
  for (const auto& attribute : sweep.attributes())
    if (attribute.name().starts_with(kAxis)) axes.emplace_back(attribute.name().substr(kAxis.size()));
  for (const std::string& axis : axes)
    if (!is_seed(axis))
      fail("the runs differ in '" + axis +
           "'; a study takes runs that differ in their seed alone: sweep the seed, one study for each '" + axis + "'");
  if (axes.size() > 1) fail("the runs differ in '" + axes[0] + "' and '" + axes[1] + "'; needed: one seed");
  if (axes.empty()) return {};
  const auto array = sweep.array("axis." + axes.front());
  if (!array || array->element != BF_F64) fail("the seeds of the sweep are not numbers");
  const auto values = array->as<double>();
  std::vector<double> seeds(values.begin(), values.end()), sorted = seeds;
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    fail("seed " + std::to_string(std::llround(*twice)) +
         " occurs twice: these runs are one and the same, and the spread too small");
  return seeds;
}

/// An array of the record, unless the list is empty.
void put(RecordBuilder& record, const char* name, const std::vector<double>& values) {
  if (values.empty()) return;
  const auto data = record.array<double>(name, "", {values.size()});
  std::copy(values.begin(), values.end(), data.begin());
}

}  // namespace

void MonteCarlo::describe(Describe& d) {
  d.id("validation.monte_carlo")
      .summary("Mean and spread of what the runs of a sweep gave, beside the truth and published figures.");
  d.doc(
      "A phase with `sweep: {seed: 1..100}` leaves a record `sweep` that holds each number of its runs as an array; connect it "
      "with "
      "`$phase.block -> name`. The record `monte_carlo` has, one entry a quantity: `mean`, `std` (of one run, with n - 1), "
      "`truth`, "
      "`bias` (mean - truth), `published_mean`, `published_std`; where the runs state a covariance, `predicted_std` (root mean "
      "square over the runs) and `coverage`, the share of runs whose 95 % interval holds the truth.");
  d.message_in(sweep).record_type("sweep").doc("one record, of runs that differ in their seed alone");
  d.message_out(out).record_type("monte_carlo");
  d.message_out(response)
      .record_type("frequency_response")
      .doc(
          "the mean of the runs' responses with the variance of one run, where they are models or responses of one input and "
          "output");
  d.parameter("quantities", std::vector<std::string>{"parameters"})
      .doc(
          "what of the runs' records: arrays or numbers (`parameters`, input_noise_variance), entries of arrays (`poles[0]`), "
          "names "
          "of parameters; a complex number counts as two quantities, real and imaginary part");
  d.parameter("names", std::vector<std::string>{}).doc("one a quantity; default: as the records say");
  d.parameter("units", std::vector<std::string>{}).doc("one a quantity; default: as the records say");
  d.parameter("scale", std::vector<double>{}).unit("1").doc("multiplies the quantities: one for all, or one each");
  d.parameter("truth", std::vector<double>{}).unit("1").doc("true values, after `scale`, one a quantity");
  d.parameter("published_mean", std::vector<double>{}).unit("1").doc("means of a published study, one a quantity");
  d.parameter("published_std", std::vector<double>{}).unit("1").doc("its standard deviations, one a quantity");
  d.optional<double>("frequency.first").unit("Hz").above(0.0).doc("first frequency of `response`, for runs that are models");
  d.optional<double>("frequency.last").unit("Hz").above(0.0).doc("last one; default: half the sample rate of the models");
  d.parameter("frequency.count", std::int64_t{200}).range(2, 1e6).doc("how many frequencies");
  d.parameter("frequency.spacing", "linear").choices({"linear", "logarithmic"}).doc("of the frequencies");
}

void MonteCarlo::configure(const Parameters& p) {
  sources_ = p.texts("quantities");
  names_ = p.texts("names");
  units_ = p.texts("units");
  scale_ = p.numbers("scale");
  truth_ = p.numbers("truth");
  published_mean_ = p.numbers("published_mean");
  published_std_ = p.numbers("published_std");
  if (sources_.empty()) fail("quantities is empty; needed: at least one");
  for (const double s : published_std_)
    if (!(s >= 0.0)) fail("published_std: " + records::short_number(s) + " is no standard deviation");
  grid_ = FrequencyGrid{};
  if (p.has("frequency.first")) grid_.first_hz = p.number("frequency.first");
  if (p.has("frequency.last")) grid_.last_hz = p.number("frequency.last");
  grid_.count = p.integer("frequency.count");
  grid_.logarithmic = p.text("frequency.spacing") == "logarithmic";
}

void MonteCarlo::receive(int, const RecordView& record, Io&) {
  if (runs_ > 0) fail("a second sweep arrived; one study takes one");
  const auto runs = sweep_runs(record);
  if (!runs) fail(runs.error().text);
  if (*runs < 2) fail("the sweep has 1 run; a spread needs at least 2");
  seeds_ = seeds_of(record);
  auto quantities = sweep_quantities(record, sources_);
  if (!quantities) fail(quantities.error().text);
  quantities_ = std::move(*quantities);
  relabel();
  auto mean = run_responses(record, grid_);
  if (!mean) fail(mean.error().text);
  mean_response_ = std::move(*mean);
  of_ = record.text("of").value_or("");
  runs_ = *runs;
}

void MonteCarlo::relabel() {
  require_fit("names", names_, quantities_);
  require_fit("units", units_, quantities_);
  require_fit("truth", truth_, quantities_);
  require_fit("published_mean", published_mean_, quantities_);
  require_fit("published_std", published_std_, quantities_);
  if (scale_.size() != 1) require_fit("scale", scale_, quantities_);
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    Quantity& q = quantities_[i];
    if (!names_.empty()) q.name = names_[i];
    if (!units_.empty()) q.unit = units_[i];
    if (scale_.empty()) continue;
    const double factor = scale_[scale_.size() == 1 ? 0 : i];
    q.values *= factor;
    q.own_deviation *= std::abs(factor);
  }
}

RecordBuilder MonteCarlo::study() const {
  RecordBuilder r("monte_carlo");
  r.set("runs", runs_);
  r.set("of", of_);
  if (!seeds_.empty()) {
    const auto [first, last] = std::minmax_element(seeds_.begin(), seeds_.end());
    r.set("seed", std::llround(*first));
    r.set("last_seed", std::llround(*last));
  }
  std::vector<std::string> names, units;
  std::vector<double> means, deviations, bias, predicted, covered;
  bool any_predicted = false;
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    const Quantity& q = quantities_[i];
    const Spread s = spread(q.values);
    const bool states = q.own_deviation.size() > 0;
    names.push_back(q.name);
    units.push_back(q.unit);
    means.push_back(s.mean);
    deviations.push_back(s.std);
    if (!truth_.empty()) bias.push_back(s.mean - truth_[i]);
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    any_predicted |= states;
    predicted.push_back(states ? std::sqrt(q.own_deviation.array().square().mean()) : kUnknown);
    if (!truth_.empty()) covered.push_back(states ? coverage(q.values, q.own_deviation, truth_[i]) : kUnknown);
  }
  r.set("quantity_names", names);
  r.set("quantity_units", units);
  put(r, "mean", means);
  put(r, "std", deviations);
  put(r, "truth", truth_);
  put(r, "bias", bias);
  put(r, "published_mean", published_mean_);
  put(r, "published_std", published_std_);
  if (any_predicted) put(r, "predicted_std", predicted);
  if (any_predicted) put(r, "coverage", covered);
  return r;
}

void MonteCarlo::finish(Io& io) {
  if (runs_ == 0) fail("no sweep arrived; connect the record of a phase with `sweep:`");
  io.emit(out, study());
  if (mean_response_) io.emit(response, records::write_response(*mean_response_));
}

void MonteCarlo::reset() {
  quantities_.clear();
  seeds_.clear();
  of_.clear();
  mean_response_.reset();
  runs_ = 0;
}

}  // namespace bodeflow::validation
