#include "linearity_block.hpp"

#include "records/record_arrays.hpp"

namespace bodeflow::spectrum {
namespace {

std::vector<std::string> warnings_of(const Linearity& l) {
  const LevelComparison& second = l.comparisons.front();
  if (l.linear_levels == 1) {
    return {"already the two smallest levels differ, by " + short_number(100.0 * second.relative_difference, 2) +
            " %: the plant is not linear at any of them; measure at smaller amplitudes, or at larger ones where dead time or "
            "friction rules the small ones"};
  }
  return {};
}

}  // namespace

void LinearityBlock::describe(Describe& d) {
  d.id("spectrum.linearity").summary("Tests up to which amplitude frequency responses agree, and recommends it.");
  d.doc(
      "Responses measured at two or more amplitudes, each beside the weighted mean of those below it: at every line "
      "|G - G_0|^2/(v + v_0) gives a probability p_k, and -2 sum ln p_k is chi-squared with two degrees a line where only noise "
      "makes them differ; the same with mean relative differences of groups of lines, for what changes smoothly. The largest "
      "amplitude before the first level that differs is recommended. Blind to what is alike at "
      "all "
      "levels.");
  d.reference("R. A. Fisher, Statistical Methods for Research Workers, 4th ed. 1932, section 21.1");
  d.message_in(in).record_type("frequency_response").doc("the responses, one record a level, at the same lines");
  d.message_out(out).record_type("linearity").doc("linear or not, probabilities, differences, the recommended amplitude");
  d.message_out(change_out)
      .record_type("parameter_change")
      .doc("the recommended level as value of `parameter`, for `block.parameters` in a later phase");
  d.parameter("levels", std::vector<double>{})
      .range(1e-12, 1e12)
      .doc("what set the amplitude of each record, in order of arrival; default: the rms of the lines' measured peak values");
  d.parameter("significance", 0.05).unit("1").above(0.0).below(1.0).doc("probability of calling a linear plant nonlinear");
  d.parameter("parameter", "gain").doc("the parameter that the record at `change` sets");
}

void LinearityBlock::configure(const Parameters& p) {
  levels_ = p.numbers("levels");
  significance_ = p.number("significance");
  parameter_ = p.text("parameter");
}

void LinearityBlock::activate(const Activation&) { reset(); }

void LinearityBlock::receive(int, const RecordView& record, Io&) {
  auto data = read_response(record);
  if (!data) fail("response " + std::to_string(responses_.size() + 1) + ": " + data.error().text);
  if (const auto mean = record.array("input_mean")) unit_ = mean->unit;
  responses_.push_back(std::move(*data));
}

std::vector<double> LinearityBlock::amplitudes() const {
  if (!levels_.empty()) return levels_;
  std::vector<double> all;
  for (std::size_t e = 0; e < responses_.size(); ++e) {
    const auto amplitude = line_amplitude(responses_[e]);
    if (!amplitude) fail("response " + std::to_string(e + 1) + ": " + amplitude.error().text);
    all.push_back(*amplitude);
  }
  return all;
}

RecordBuilder LinearityBlock::record(const Linearity& l, const std::vector<std::string>& warnings) const {
  RecordBuilder r("linearity");
  r.set("linear", l.linear());
  r.set("p_value", l.p_value);
  r.set("significance", significance_);
  r.set("recommended_amplitude", l.largest_linear());
  r.set("levels_that_agree", static_cast<std::int64_t>(l.linear_levels));
  r.set("warnings", warnings);
  const auto each = [&](const char* name, auto get) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(l.comparisons.size()));
    for (std::size_t n = 0; n < l.comparisons.size(); ++n) values[static_cast<Eigen::Index>(n)] = get(l.comparisons[n]);
    records::put_list<double>(r, name, "", values);
  };
  records::put_list<double>(
      r, "amplitude", levels_.empty() ? unit_ : "",
      Eigen::Map<const Eigen::VectorXd>(l.amplitudes.data(), static_cast<Eigen::Index>(l.amplitudes.size())));
  each("level_p_value", [](const LevelComparison& c) { return c.p_value; });
  each("lines_p_value", [](const LevelComparison& c) { return c.lines_p_value; });
  each("smooth_p_value", [](const LevelComparison& c) { return c.smooth_p_value; });
  each("relative_difference", [](const LevelComparison& c) { return c.relative_difference; });
  each("relative_noise", [](const LevelComparison& c) { return c.relative_noise; });
  records::put_list<double>(r, "frequency", "Hz", responses_.front().frequency_hz);
  const Eigen::Index lines = responses_.front().frequency_hz.size();
  Eigen::MatrixXd line_p_value(static_cast<Eigen::Index>(l.comparisons.size()), lines);
  for (std::size_t n = 0; n < l.comparisons.size(); ++n)
    line_p_value.row(static_cast<Eigen::Index>(n)) = l.comparisons[n].line_p_value.transpose();
  records::put_matrix(r, "line_p_value", "", line_p_value);
  return r;
}

void LinearityBlock::finish(Io& io) {
  const auto found = linearity(responses_, amplitudes(), significance_);
  if (!found) fail(found.error().text);
  const std::vector<std::string> warnings = warnings_of(*found);
  io.emit(out, record(*found, warnings));
  RecordBuilder change("parameter_change");
  change.set("parameter", parameter_);
  change.set("value", found->largest_linear());
  io.emit(change_out, change);
  for (const std::string& warning : warnings) log_warning(warning);
}

void LinearityBlock::reset() {
  responses_.clear();
  unit_.clear();
}

}  // namespace bodeflow::spectrum
