#include "local_polynomial_record.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "records.hpp"
#include "response_record.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kInputOverNoise = 10.0;  // 10 dB
constexpr double kResiduals = 3.0;        // times those beside: with 7 degrees of freedom chance gives less than twice
constexpr double kMatters = 0.02;         // of the peak: less is well inside what the variance tells

double line_spacing_hz(const LocalPolynomialOrigin& from) { return from.sample_rate_hz / static_cast<double>(from.samples); }

double frequency_of(std::int64_t line, const LocalPolynomialOrigin& from) {
  return static_cast<double>(line) * line_spacing_hz(from);
}

/// The row of the highest peak of |G| in a column that the polynomials do not follow: the residuals around it are far above those
/// beside it, and matter. Nothing where there is none.
std::optional<Eigen::Index> flattened_peak(const LocalPolynomialEstimate& e, Eigen::Index column, Eigen::Index beside) {
  const Eigen::VectorXd size = e.response.col(column).cwiseAbs();
  const Eigen::VectorXd level = e.noise_level.col(column / (e.response.cols() / e.noise_level.cols()));
  std::optional<Eigen::Index> highest;
  for (Eigen::Index k = beside; k + beside < size.size(); ++k) {
    const bool peak = size[k] >= size.segment(k - beside, 2 * beside + 1).maxCoeff();
    const bool rises = level[k] > kResiduals * std::max(level[k - beside], level[k + beside]);
    const bool matters = std::sqrt(e.variance(k, column)) > kMatters * size[k];
    if (peak && rises && matters && (!highest || size[k] > size[*highest])) highest = k;
  }
  return highest;
}

void warn_of_peaks(const LocalPolynomialEstimate& e, const LocalPolynomialOrigin& from, std::vector<std::string>& warnings) {
  if (!e.silent_lines.empty()) return;  // rows are not equally spaced then
  // Beyond 2n lines a fit shares nothing with that at the peak.
  const Eigen::Index beside = (5 * from.settings.half_width / 2 + from.step - 1) / from.step;
  for (Eigen::Index c = 0; c < e.response.cols(); ++c) {
    const auto row = flattened_peak(e, c, beside);
    if (!row) continue;
    const std::string frequency = short_number(frequency_of(e.lines[static_cast<std::size_t>(*row)], from));
    warnings.push_back("around the peak at " + frequency +
                       " Hz the residuals are far above those beside it: the resonance is narrower than a fit of " +
                       std::to_string(2 * from.settings.half_width + 1) + " lines follows (" +
                       short_number(static_cast<double>(2 * from.settings.half_width + 1) * line_spacing_hz(from)) +
                       " Hz), so its height is wrong, or noise passes through it; measure longer, or lower half_width");
    return;
  }
}

}  // namespace

std::vector<std::string> local_polynomial_warnings(const LocalPolynomialEstimate& e, const LocalPolynomialOrigin& from) {
  std::vector<std::string> warnings = from.warnings;
  if (!e.silent_lines.empty()) {
    warnings.push_back(
        counted(static_cast<std::int64_t>(e.silent_lines.size()), "line") + " between " +
        short_number(frequency_of(e.silent_lines.front(), from)) + " and " +
        short_number(frequency_of(e.silent_lines.back(), from)) +
        " Hz left out: the input is silent or too smooth there to tell plant from transient; choose the band that is "
        "excited, or an input that is rough from line to line");
  }
  if (e.least_input_ratio < kInputOverNoise) {
    warnings.push_back("what the reference causes at the input is only " +
                       short_number(std::round(10.0 * e.least_input_ratio) / 10.0) +
                       " times its variance at the worst line (needed: 10): the response is biased there; excite more, measure "
                       "longer, or choose the band that is excited");
  } else {
    warn_of_peaks(e, from, warnings);
  }
  return warnings;
}

RecordBuilder local_polynomial_record(const LocalPolynomialEstimate& e, const LocalPolynomialOrigin& from) {
  ResponseData d;
  const bool closed = !from.references.names.empty();
  d.form = closed ? "reference" : "local_polynomial";
  d.method = "spectrum.local_polynomial";
  d.input_names = from.inputs.names;
  d.output_names = from.outputs.names;
  d.response_units = response_units(from.outputs.units, from.inputs.units);
  d.warnings = from.warnings;
  d.realisations = 1;
  d.sample_rate_hz = from.sample_rate_hz;
  d.degrees_of_freedom = e.degrees_of_freedom;
  d.correlated_lines = 2 * static_cast<std::int64_t>(from.settings.half_width) / from.step;
  d.input_amplitude = from.input_amplitude;
  d.lines = e.lines;
  d.frequency_hz.resize(static_cast<Eigen::Index>(e.lines.size()));
  for (std::size_t k = 0; k < e.lines.size(); ++k) d.frequency_hz[static_cast<Eigen::Index>(k)] = frequency_of(e.lines[k], from);
  d.response = e.response;
  d.variance = e.variance;

  RecordBuilder r = write_response(d);
  r.set("samples", from.samples);
  r.set("order", static_cast<std::int64_t>(from.settings.order));
  r.set("half_width", static_cast<std::int64_t>(from.settings.half_width));
  r.set("transient", from.settings.transient);
  if (closed) r.set("reference_names", from.references.names);
  const std::string unit = common_unit(from.outputs.units);
  put_matrix(r, "noise_level", unit, e.noise_level);
  if (e.transient_level.size() != 0) put_matrix(r, "transient_level", unit, e.transient_level);
  return r;
}

}  // namespace bodeflow::spectrum
