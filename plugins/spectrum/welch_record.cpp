#include "welch_record.hpp"

#include <algorithm>
#include <cmath>

#include "narrow_peaks.hpp"
#include "records.hpp"
#include "response_record.hpp"
#include "window.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kFewAverages = 10.0;
constexpr double kLowCoherence = 0.5;
// A 3 dB bandwidth of four lines is the least that a Hann window shows without flattening it by more than about 5 %.
constexpr double kNarrowLines = 4.0;
constexpr std::size_t kNamed = 3;

double line_spacing_hz(const WelchSettings& s) { return s.sample_rate_hz / static_cast<double>(s.segment); }

void warn_of_coherence(const WelchEstimate& e, const WelchOrigin& from, std::vector<std::string>& warnings) {
  for (Eigen::Index i = 0; i < e.coherence.cols(); ++i) {
    const auto low = (e.coherence.col(i).array() < kLowCoherence).count();
    if (2 * low <= e.coherence.rows()) continue;
    std::vector<double> sorted(e.coherence.col(i).begin(), e.coherence.col(i).end());
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    warnings.push_back("the coherence of output '" + from.outputs.names[static_cast<std::size_t>(i)] + "' is below " +
                       short_number(kLowCoherence) + " at " + std::to_string(low) + " of " + counted(e.coherence.rows(), "line") +
                       " (median " + short_number(sorted[sorted.size() / 2]) +
                       "): noise, distortion, leakage or another input prevails there; excite those frequencies more, average "
                       "longer, take longer segments, or choose the band that is excited");
  }
}

void warn_of_peaks(const WelchEstimate& e, const WelchOrigin& from, std::vector<std::string>& warnings) {
  std::vector<Peak> found;
  for (Eigen::Index c = 0; c < e.response.cols(); ++c) {
    for (const Peak& p : narrow_peaks(e.response.col(c), e.variance.col(c), kNarrowLines)) {
      const bool known = std::any_of(found.begin(), found.end(), [&](const Peak& q) { return std::abs(q.row - p.row) <= 2; });
      if (!known) found.push_back(p);
    }
  }
  if (found.empty()) return;
  std::string places;
  double narrowest = kNarrowLines;
  for (std::size_t i = 0; i < found.size(); ++i) {
    narrowest = std::min(narrowest, found[i].width_lines);
    if (i >= kNamed) continue;
    const auto line = static_cast<double>(e.lines[static_cast<std::size_t>(found[i].row)]);
    places += (i == 0 ? "" : ", ") + short_number(line * line_spacing_hz(from.settings)) + " Hz";
  }
  if (found.size() > kNamed) places += " and " + std::to_string(found.size() - kNamed) + " more";
  warnings.push_back(
      "the peak at " + places + " is " + short_number(std::round(10.0 * narrowest) / 10.0) +
      " lines wide (3 dB), needed: 4: its height and width are those of the window, not of the plant; take a segment at "
      "least " +
      std::to_string(static_cast<int>(std::ceil(kNarrowLines / narrowest)) + 1) + " times as long, or spectrum.local_polynomial");
}

}  // namespace

std::string name_of(WelchForm form) { return form == WelchForm::h1 ? "h1" : form == WelchForm::h2 ? "h2" : "hv"; }

double resolution_hz(const WelchSettings& s) { return noise_bandwidth_lines(window(s.window, s.segment)) * line_spacing_hz(s); }

std::vector<std::string> welch_warnings(const WelchEstimate& e, const WelchOrigin& from) {
  std::vector<std::string> warnings = from.warnings;
  if (e.effective_averages < kFewAverages) {
    warnings.push_back(counted(e.averages, "segment") + " are worth " +
                       short_number(std::round(10.0 * e.effective_averages) / 10.0) +
                       " averages: response, variance and coherence are rough below 10; measure longer or take shorter segments");
  }
  warn_of_coherence(e, from, warnings);
  warn_of_peaks(e, from, warnings);
  return warnings;
}

RecordBuilder welch_record(const WelchEstimate& e, const WelchOrigin& from) {
  ResponseData d;
  d.form = name_of(from.form);
  d.method = "spectrum.welch";
  d.input_names = from.inputs.names;
  d.output_names = from.outputs.names;
  d.response_units = response_units(from.outputs.units, from.inputs.units);
  d.warnings = from.warnings;
  d.realisations = 1;
  d.sample_rate_hz = from.settings.sample_rate_hz;
  d.degrees_of_freedom = e.degrees_of_freedom;
  d.correlated_lines = correlated_lines(from.settings.window);
  d.input_amplitude = from.input_amplitude;
  d.lines = e.lines;
  d.frequency_hz.resize(static_cast<Eigen::Index>(e.lines.size()));
  for (Eigen::Index k = 0; k < d.frequency_hz.size(); ++k)
    d.frequency_hz[k] = static_cast<double>(e.lines[static_cast<std::size_t>(k)]) * line_spacing_hz(from.settings);
  d.response = e.response;
  d.variance = e.variance;

  RecordBuilder r = write_response(d);
  r.set("segment", static_cast<std::int64_t>(from.settings.segment));
  r.set("hop", static_cast<std::int64_t>(from.settings.hop));
  r.set("window", from.settings.window);
  r.set("averages", e.averages);
  r.set("effective_averages", e.effective_averages);
  r.set("resolution", resolution_hz(from.settings));
  const auto density = [](const std::string& unit) { return unit.empty() ? unit : squared_unit(unit) + "/Hz"; };
  put_matrix(r, "coherence", "1", e.coherence);
  put_matrix(r, "input_density", density(common_unit(from.inputs.units)), e.input_density);
  put_matrix(r, "output_density", density(common_unit(from.outputs.units)), e.output_density);
  return r;
}

}  // namespace bodeflow::spectrum
