#include "delay_block.hpp"

#include <algorithm>
#include <cmath>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kMisfit = 2.0;          // times the noise
constexpr double kRelativeMisfit = 0.1;  // of G, where the noise is not known
constexpr double kRival = 9.0;           // in the sum of squares: three standard deviations

/// The place of a name; the first one where none is asked for.
Eigen::Index place_of(const std::string& name, const std::vector<std::string>& names, const char* what) {
  if (name.empty()) return 0;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return found - names.begin();
  std::string allowed;
  for (const std::string& n : names) allowed += (allowed.empty() ? "'" : ", '") + n + "'";
  fail(std::string(what) + " '" + name + "' is not in the record; it has " + allowed);
}

std::vector<std::string> warnings_of(const DelayEstimate& e) {
  std::vector<std::string> warnings;
  const bool far = std::isnan(e.misfit) ? e.relative_error > kRelativeMisfit : e.misfit > kMisfit;
  if (far) {
    warnings.push_back(
        "a delayed gain leaves " + short_number(std::round(1000.0 * e.relative_error) / 10.0) + " % of the response" +
        (std::isnan(e.misfit) ? "" : ", " + short_number(std::round(10.0 * e.misfit) / 10.0) + " times its noise") +
        ": the plant has dynamics in this band, and the delay holds their lag; choose a band without, give `slope` for "
        "an integrator, or identify a model with a delay");
  }
  if (e.rival_excess < kRival)
    warnings.push_back("a delay of " + short_number(e.rival_s) +
                       " s fits almost as well: give `largest_delay`, or take a wider band");
  if (e.delay_s < -3.0 * e.standard_deviation_s)
    warnings.push_back("the delay is negative: are input and output exchanged, or is their sampling shifted?");
  return warnings;
}

}  // namespace

void DelayBlock::describe(Describe& d) {
  d.id("spectrum.delay").summary("Estimates the delay in a frequency response over a band.");
  d.doc(
      "Least squares with the record's variances: G = a (j omega)^slope exp(-j omega delay), a real. Right where the plant is a "
      "delayed gain (or "
      "integrator) over the band; each pole or zero beyond the band adds about its time constant to the delay, and dynamics "
      "inside it are "
      "told by the misfit.");
  d.reference("G. C. Carter, Coherence and time delay estimation, 1987, doi:10.1109/PROC.1987.13723");
  d.message_in(in).record_type("frequency_response").doc("the frequency response");
  d.message_out(out).record_type("delay_estimate").doc("the delay, for each record that arrives");
  d.parameter("band", std::vector<double>{}).unit("Hz").range(0, 1e15).doc("[from, to]; default: all lines above zero");
  d.parameter("slope", std::int64_t{0})
      .range(-6, 6)
      .doc("power of j omega of the plant beside the delay: -1 an integrator, 1 a derivative");
  d.optional<double>("largest_delay")
      .unit("s")
      .above(0)
      .doc("how far is looked; default: half of the inverse of the line spacing");
  d.parameter("input", "").doc("name of the input; default: the first");
  d.parameter("output", "").doc("name of the output; default: the first");
}

void DelayBlock::configure(const Parameters& p) {
  band_hz_ = p.numbers("band");
  if (!band_hz_.empty() && (band_hz_.size() != 2 || !(band_hz_[0] < band_hz_[1])))
    fail("band needs two rising frequencies: [from, to]");
  slope_ = static_cast<int>(p.integer("slope"));
  if (p.has("largest_delay")) largest_s_ = p.number("largest_delay");
  input_ = p.text("input");
  output_ = p.text("output");
}

DelayProblem DelayBlock::problem_of(const ResponseData& d, Eigen::Index output, Eigen::Index input) const {
  std::vector<Eigen::Index> rows;
  const Eigen::Index column = output * d.inputs() + input;
  const bool certain = d.variance.size() != 0 && d.variance.col(column).minCoeff() > 0.0;
  for (Eigen::Index k = 0; k < d.frequency_hz.size(); ++k) {
    const double f = d.frequency_hz[k];
    if (f > 0.0 && (band_hz_.empty() || (f >= band_hz_[0] && f <= band_hz_[1]))) rows.push_back(k);
  }
  DelayProblem p;
  p.slope = slope_;
  p.largest_s = largest_s_;
  p.frequency_hz = d.frequency_hz(rows);
  p.response = d.response(rows, column);
  if (certain) p.variance = d.variance(rows, column);
  return p;
}

void DelayBlock::receive(int, const RecordView& record, Io& io) {
  const auto data = read_response(record);
  if (!data) fail(data.error().text);
  const Eigen::Index output = place_of(output_, data->output_names, "output"),
                     input = place_of(input_, data->input_names, "input");
  const DelayProblem problem = problem_of(*data, output, input);
  const auto e = delay_of(problem);
  if (!e) fail(e.error().text);
  RecordBuilder r("delay_estimate");
  r.set("delay", e->delay_s);
  r.set("standard_deviation", e->standard_deviation_s);
  if (data->sample_rate_hz) {
    r.set("delay_samples", e->delay_s * *data->sample_rate_hz);
    r.set("standard_deviation_samples", e->standard_deviation_s * *data->sample_rate_hz);
  }
  r.set("gain", e->gain);
  if (!std::isnan(e->misfit)) r.set("misfit", e->misfit);
  r.set("relative_error", e->relative_error);
  r.set("band", std::vector<double>{problem.frequency_hz[0], problem.frequency_hz[problem.frequency_hz.size() - 1]});
  r.set("lines", problem.frequency_hz.size());
  r.set("largest_delay", e->largest_s);
  r.set("slope", slope_);
  r.set("input_name", data->input_names[static_cast<std::size_t>(input)]);
  r.set("output_name", data->output_names[static_cast<std::size_t>(output)]);
  const std::vector<std::string> warnings = warnings_of(*e);
  r.set("warnings", warnings);
  io.emit(out, r);
  for (const std::string& warning : warnings) log_warning(warning);
}

}  // namespace bodeflow::spectrum
