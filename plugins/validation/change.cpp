#include "change.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::validation {
namespace {

using records::short_number;

std::string percent(double share) { return short_number(100.0 * share, 3) + " %"; }

std::string scatter_text(const Scatter& s) {
  if (!s.known()) return "unknown";
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (s.relative > 0.0) add("stated, " + percent(s.relative) + " of the response");
  if (s.absolute > 0.0) add("stated, " + short_number(s.absolute));
  if (!s.repeats.empty()) add("from " + records::counted(static_cast<std::int64_t>(s.repeats.size()), "repeat test"));
  return text;
}

void add_modes(EntryChange& e, const ChangeSettings& settings) {
  const ChangeLines& c = e.lines;
  auto before = fit_modes(c.frequency_hz, c.before, c.before_noise + c.scatter, settings.modes);
  auto after = fit_modes(c.frequency_hz, c.after, c.after_noise + c.scatter, settings.modes);
  if (!before || !after) {
    e.no_modes = (before ? "after: " + after.error().text : "before: " + before.error().text);
    return;
  }
  e.before = std::move(*before);
  e.after = std::move(*after);
  e.modes = mode_changes(c, e.spectrum, e.before->modes, e.after->modes, settings.apart, settings.spectrum.confidence);
}

/// "12 Hz to 30 Hz and 60 Hz to 90 Hz": bands with that verdict in any entry, neighbours taken together.
std::string bands_text(const ResponseChange& r, Verdict verdict) {
  const auto& bands = r.entries.front().spectrum.bands;
  std::string text;
  std::size_t first = 0;
  const auto is = [&](std::size_t b) {
    return std::any_of(r.entries.begin(), r.entries.end(),
                       [&](const EntryChange& e) { return e.spectrum.bands[b].verdict == verdict; });
  };
  for (std::size_t b = 0; b < bands.size(); ++b) {
    if (!is(b)) continue;
    if (b == 0 || !is(b - 1)) first = b;
    if (b + 1 < bands.size() && is(b + 1)) continue;
    text +=
        (text.empty() ? "" : " and ") + short_number(bands[first].low_hz, 4) + " to " + short_number(bands[b].high_hz, 4) + " Hz";
  }
  return text;
}

std::string conclusion_of(const ResponseChange& r) {
  double detectable = 0.0;
  for (const EntryChange& e : r.entries)
    for (const BandChange& b : e.spectrum.bands) detectable = std::max(detectable, b.detectable);
  if (r.verdict == Verdict::changed) {
    return "changed in " + bands_text(r, Verdict::changed) +
           (r.scatter_known ? "" : ", beyond the noise of the measurements; by how much repeat tests differ is unknown");
  }
  if (r.verdict == Verdict::unchanged)
    return "unchanged: a change of " + percent(detectable) + " or more of any band would have been found";
  if (!r.variance_known) return "not decidable: neither a variance nor the scatter of repeat tests is known";
  return "not decidable in " + bands_text(r, Verdict::undecidable) + ": only a change of " + percent(detectable) +
         " or more would be found there";
}

void add_warnings(ResponseChange& r, const records::ResponseData& before) {
  if (!r.scatter_known) {
    r.warnings.push_back(
        "the scatter of repeat tests is unknown: connections, leads and temperature make two measurements of an unchanged plant "
        "differ; measure once more with nothing changed and give that as a repeat, or state the scatter");
  }
  if (r.interpolated > 0) {
    r.warnings.push_back("the responses stand at different frequencies: the second is interpolated at " +
                         records::counted(r.interpolated, "line") + "; narrow resonances need the same lines");
  }
  if (r.left_out > 0)
    r.warnings.push_back(records::counted(r.left_out, "line") + " of the first response lies outside of the second's range");
  for (const EntryChange& e : r.entries) {
    const std::string of = before.response.cols() > 1 ? e.name + ": " : "";
    if (!e.no_modes.empty()) r.warnings.push_back(of + "no modes, " + e.no_modes);
    for (const auto& [model, when] : {std::pair{&e.before, "before"}, {&e.after, "after"}}) {
      if (*model && (*model)->fit > 2.0)
        r.warnings.push_back(of + "the model " + when + " leaves " + short_number((*model)->fit, 3) +
                             " times the variance: its poles may stand for something else; the intervals are widened by that");
    }
  }
}

}  // namespace

Expected<ResponseChange> response_change(const records::ResponseData& before, const records::ResponseData& after,
                                         const Scatter& scatter, const ChangeSettings& settings) {
  auto aligned = align(before, after, scatter);
  if (!aligned) return unexpected(aligned.error().text);
  ResponseChange r;
  r.interpolated = aligned->interpolated;
  r.left_out = aligned->left_out;
  r.scatter = scatter_text(scatter);
  r.scatter_known = scatter.known();
  const auto count = static_cast<Eigen::Index>(aligned->entries.size());
  bool any = false, all = true;
  r.variance_known = true;
  for (Eigen::Index i = 0; i < count; ++i) {
    EntryChange e;
    const auto entry = static_cast<std::size_t>(i);
    e.name =
        before.output_names[entry / before.input_names.size()] + " / " + before.input_names[entry % before.input_names.size()];
    e.unit = before.response_units[entry];
    e.lines = std::move(aligned->entries[entry]);
    for (Eigen::Index k = 0; k < e.lines.lines(); ++k) r.variance_known = r.variance_known && e.lines.variance(k) > 0.0;
    auto spectrum = spectrum_change(e.lines, settings.spectrum, count);
    if (!spectrum) return unexpected(spectrum.error().text);
    e.spectrum = std::move(*spectrum);
    const Eigen::VectorXd x = decibels(e.lines.before), y = decibels(e.lines.after);
    e.correlation = correlation_coefficient(x, y);
    e.factor = relative_factor(x, y);
    e.standard = standard_factors(e.lines.frequency_hz, e.lines.before, e.lines.after);
    if (settings.find_modes) add_modes(e, settings);
    any = any || e.spectrum.verdict == Verdict::changed;
    all = all && e.spectrum.verdict == Verdict::unchanged;
    r.entries.push_back(std::move(e));
  }
  r.verdict = any ? Verdict::changed : all ? Verdict::unchanged : Verdict::undecidable;
  r.conclusion = conclusion_of(r);
  add_warnings(r, before);
  return r;
}

}  // namespace bodeflow::validation
