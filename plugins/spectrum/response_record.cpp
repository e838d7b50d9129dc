#include "response_record.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

using Complex = std::complex<double>;
using Shape = std::initializer_list<std::uint64_t>;

/// Adds a matrix as an array of that shape, left out where it is empty.
void put_if_any(RecordBuilder& record, const char* name, const std::string& unit, Shape shape, const Eigen::MatrixXd& m) {
  if (m.size() > 0) put<double>(record, name, unit, shape, m);
}

struct Units {
  explicit Units(const Measurement& from)
      : inputs(from.units.begin(), from.units.begin() + from.layout.inputs),
        outputs(from.units.begin() + from.layout.inputs, from.units.begin() + from.layout.inputs + from.layout.outputs),
        ratios(response_units(outputs, inputs)) {}
  std::vector<std::string> inputs, outputs, ratios;  // ratios: output by output
};

std::vector<std::string> part(const std::vector<std::string>& all, Eigen::Index from, Eigen::Index count) {
  return {all.begin() + from, all.begin() + from + count};
}

void put_signals(RecordBuilder& r, const Estimate& e, const Units& units) {
  if (e.input_mean.size() == 0) return;
  const auto lines = static_cast<std::uint64_t>(e.lines.size()), outputs = static_cast<std::uint64_t>(e.output_mean.cols());
  const std::string &input = units.inputs.front(), output = common_unit(units.outputs);
  put<Complex>(r, "input_mean", input, {lines, 1}, e.input_mean);
  put<double>(r, "input_variance", squared_unit(input), {lines, 1}, e.input_variance);
  put<Complex>(r, "output_mean", output, {lines, outputs}, e.output_mean);
  put<double>(r, "output_variance", squared_unit(output), {lines, outputs}, e.output_variance);
  put<Complex>(r, "cross_covariance", "", {lines, outputs, 1}, e.cross_covariance);
}

void put_lines(RecordBuilder& r, const std::vector<std::int64_t>& lines) {
  const auto numbers = r.array<std::int64_t>("line", "", {static_cast<std::uint64_t>(lines.size())});
  std::copy(lines.begin(), lines.end(), numbers.begin());
}

const char* form_name(Form form) {
  if (form == Form::known_input) return "known_input";
  return form == Form::reference ? "reference" : "errors_in_variables";
}

}  // namespace

void fill_frequencies(std::span<double> to, const std::vector<std::int64_t>& lines, const Rate& rate, std::int64_t period) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    to[k] = static_cast<double>(lines[k]) * static_cast<double>(rate.num) /
            (static_cast<double>(rate.den) * static_cast<double>(period));
  }
}

RecordBuilder response_record(const Estimate& e, const Levels& levels, const Measurement& from) {
  const Units units(from);
  const std::string unit = common_unit(units.ratios), output_unit = common_unit(units.outputs);
  RecordBuilder r("frequency_response");
  r.set("form", form_name(from.form));
  r.set("method", "spectrum.averaging_dft");
  r.set("periods", e.periods);
  r.set("realisations", e.realisations);
  r.set("sample_rate", from.rate.hz());
  r.set("period", from.period);
  r.set("dropped_samples", from.dropped_samples);
  r.set("input_names", part(from.names, 0, from.layout.inputs));
  r.set("output_names", part(from.names, from.layout.inputs, from.layout.outputs));
  r.set("response_units", units.ratios);
  r.set("confidence", from.confidence);
  r.set("degrees_of_freedom", e.degrees_of_freedom.minCoeff());
  r.set("correlated_lines", std::int64_t{0});
  r.set("input_amplitude", from.input_amplitude);
  r.set("warnings", from.warnings);

  const auto lines = static_cast<std::uint64_t>(e.lines.size());
  const auto outputs = static_cast<std::uint64_t>(from.layout.outputs), inputs = static_cast<std::uint64_t>(from.layout.inputs);
  fill_frequencies(r.array<double>("frequency", "Hz", {lines}), e.lines, from.rate, from.period);
  put<Complex>(r, "response", unit, {lines, outputs, inputs}, e.response);
  put<double>(r, "variance", squared_unit(unit), {lines, outputs, inputs}, e.variance);
  const Eigen::MatrixXd radius = e.variance.binaryExpr(e.degrees_of_freedom, [&](double variance, double degrees) {
    return numerics::confidence_radius(variance, degrees, from.confidence);
  });
  put<double>(r, "confidence_radius", unit, {lines, outputs, inputs}, radius);
  put_lines(r, e.lines);
  put_if_any(r, "noise_variance", squared_unit(unit), {lines, outputs, inputs}, e.noise_variance);
  put_if_any(r, "nonlinear_variance", squared_unit(unit), {lines, outputs, inputs}, e.nonlinear_variance);
  put_if_any(r, "noise_level", output_unit, {lines, outputs}, e.noise_level);
  put_if_any(r, "odd_distortion", output_unit, {lines, outputs}, level_beside(levels, e.lines, Levels::odd));
  put_if_any(r, "even_distortion", output_unit, {lines, outputs}, level_beside(levels, e.lines, Levels::even));
  put_signals(r, e, units);
  return r;
}

RecordBuilder levels_record(const Levels& levels, const Estimate& estimate, const Measurement& from) {
  const Units units(from);
  const std::string input_unit = common_unit(units.inputs), output_unit = common_unit(units.outputs);
  RecordBuilder r("spectral_levels");
  r.set("periods", estimate.periods);
  r.set("realisations", estimate.realisations);
  r.set("sample_rate", from.rate.hz());
  r.set("period", from.period);
  r.set("output_names", part(from.names, from.layout.inputs, from.layout.outputs));
  r.set("input_name", from.names.front());
  r.set("warnings", from.warnings);
  const auto lines = static_cast<std::uint64_t>(levels.lines.size());
  const auto outputs = static_cast<std::uint64_t>(from.layout.outputs);
  fill_frequencies(r.array<double>("frequency", "Hz", {lines}), levels.lines, from.rate, from.period);
  put_lines(r, levels.lines);
  const auto kinds = r.array<std::int64_t>("kind", "", {lines});
  std::copy(levels.kind.begin(), levels.kind.end(), kinds.begin());
  put<double>(r, "output_level", output_unit, {lines, outputs}, levels.output_level);
  put_if_any(r, "output_noise", output_unit, {lines, outputs}, levels.output_noise);
  put<double>(r, "input_level", input_unit, {lines}, levels.input_level.leftCols(1));
  if (levels.input_noise.size() > 0) put<double>(r, "input_noise", input_unit, {lines}, levels.input_noise.leftCols(1));
  return r;
}

}  // namespace bodeflow::spectrum
