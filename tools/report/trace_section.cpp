#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/curve.hpp"
#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

struct Bar {
  std::string name;
  double value;
  int colour;
};

/// Horizontal bars with their values, from zero.
Picture draw_bars(const std::string& title, const std::vector<Bar>& bars, const std::string& unit, double width) {
  constexpr double kRow = 34.0;
  Picture picture{title, "Bars: ", width, 0.0, {}};
  double greatest = 0.0, names = 0.0;
  for (const auto& bar : bars) {
    greatest = std::max(greatest, bar.value);
    names = std::max(names, text_width(bar.name));
    picture.description += fmt::format("{} {}; ", bar.name, shown(bar.value, unit));
  }
  const double left = names + 20.0, inner = width - left - 120.0;
  for (std::size_t n = 0; n < bars.size(); ++n) {
    const double y = 8.0 + kRow * static_cast<double>(n);
    const double length = greatest > 0.0 ? inner * bars[n].value / greatest : 0.0;
    draw_text(picture.body, left - 10.0, y + 16.0, bars[n].name, Anchor::end);
    picture.body.single("rect", {{"x", left},
                                 {"y", y},
                                 {"width", std::max(length, 1.0)},
                                 {"height", 24.0},
                                 {"class", fmt::format("m{}", bars[n].colour)}});
    draw_text(picture.body, left + length + 8.0, y + 16.0, shown(bars[n].value, unit), Anchor::start, "b");
  }
  picture.height = 8.0 + kRow * static_cast<double>(bars.size());
  return picture;
}

std::string verdict_text(const std::string& verdict) {
  if (verdict == "none") return "Nothing is missing: the model explains the data down to the noise.";
  if (verdict == "named") return "The missing effect is named.";
  if (verdict == "not_separable")
    return "Several effects explain the data equally well: they can't be told apart with these data.";
  if (verdict == "unexplained") return "Something is missing, and none of the known effects explains it.";
  return "Verdict: " + verdict;
}

void add_errors(Page& page, const Record& record) {
  struct Amount {
    const char* attribute;
    const char* name;
    int colour;
  };
  std::vector<Bar> bars;
  const bool added = !record.texts("effects").empty();
  for (const Amount& level : {Amount{"error_before", "error before", 1}, Amount{"error_after", "with the effect", 0},
                              Amount{"error_remedied", "measured again", 2}, Amount{"noise_floor", "noise floor", 5}}) {
    const double value = record.number(level.attribute);
    if (level.colour == 0 && !added && record.number("error_before") == value) continue;
    if (std::isfinite(value) && value >= 0.0) bars.push_back({level.name, value, level.colour});
  }
  if (bars.size() < 2) return;
  const std::string unit = record.text("unit"), limit = shown(record.number("noise_floor_99.9"), unit);
  const double less = record.number("excess_before"), rest = record.number("excess_after");
  const std::string excess = std::isfinite(less + rest) ? shown(less, unit) + " before, " + shown(rest, unit) + " after" : "–";
  page.figure(draw_bars("Error of the model", bars, unit, kWide), draw_bars("Error of the model", bars, unit, kNarrow),
              record.key + "_error",
              "Root mean square on the test record, which was not used before, of the mean period within the band of the lines." +
                  (limit == "–" ? "" : " The noise alone stays below " + limit + " with a probability of 99.9 %.") +
                  (added && excess != "–" ? " What is not noise: " + excess + "." : ""));
}

void add_effects(Page& page, const Record& record) {
  const Array* values = record.array("effect_parameters");
  if (values == nullptr || values->is_complex()) return;
  const Array* deviations = record.array("effect_parameter_std", values->shape);
  std::string effects;
  for (const auto& name : record.texts("effects")) effects += (effects.empty() ? "" : " and ") + name;
  Table table{"Added: " + effects, {{"Parameter", false}, {"Value"}, {"std"}}, {}};
  for (std::size_t n = 0; n < values->size(); ++n) {
    const std::string unit = record.text_at("effect_parameter_units", n, values->unit);
    table.rows.push_back({with_unit(record.text_at("effect_parameter_names", n, fmt::format("parameter {}", n + 1)), unit),
                          shown(values->re[n], 6), deviations == nullptr ? "–" : shown(deviations->re[n], 3)});
  }
  add_table(page.body(), table);
}

/// Parameters of the base model before and after: the bias that the missing effect put into them.
void add_parameters(Page& page, const Record& record) {
  const Array* before = record.array("parameters_before");
  if (before == nullptr || before->is_complex()) return;
  const Array* after = record.array("parameters_after", before->shape);
  const Array* before_std = record.array("parameters_before_std", before->shape);
  const Array* after_std = record.array("parameters_after_std", before->shape);
  if (after == nullptr) return;
  Table table{"Parameters of the model", {{"Parameter", false}, {"Before"}, {"std"}, {"After"}, {"std"}, {"Change"}}, {}};
  for (std::size_t n = 0; n < before->size(); ++n) {
    table.rows.push_back({with_unit(record.text_at("parameter_names", n, fmt::format("parameter {}", n + 1)),
                                    record.text_at("parameter_units", n, before->unit)),
                          shown(before->re[n], 6), before_std == nullptr ? "–" : shown(before_std->re[n], 3),
                          shown(after->re[n], 6), after_std == nullptr ? "–" : shown(after_std->re[n], 3),
                          percent(after->re[n] / before->re[n] - 1.0)});
  }
  add_table(page.body(), table);
}

void add_classes(Page& page, const Record& record) {
  const auto names = record.texts("class_names"), records = record.texts("class_records");
  const std::vector<std::uint64_t> shape{records.size(), names.size()};
  const Array *before = record.array("class_before", shape), *after = record.array("class_after", shape),
              *p_before = record.array("class_p_before", shape), *p_after = record.array("class_p_after", shape);
  if (names.empty() || before == nullptr || after == nullptr || p_before == nullptr || p_after == nullptr) return;
  const double limit = record.number("class_p_limit");
  Table table{"What is left, by class of lines", {{"Record", false}, {"Model", false}}, {}};
  for (const auto& name : names) table.columns.push_back({name});
  for (std::size_t r = 0; r < records.size(); ++r) {
    for (const bool late : {false, true}) {
      std::vector<std::string> row{late ? "" : records[r], late ? "after" : "before"};
      for (std::size_t c = 0; c < names.size(); ++c) {
        const std::size_t at = r * names.size() + c;
        const bool found = (late ? p_after : p_before)->re[at] < limit;
        row.push_back(shown((late ? after : before)->re[at], 3) + (found ? " *" : ""));
      }
      table.rows.push_back(std::move(row));
    }
  }
  add_table(page.body(), table);
  page.paragraph(
      fmt::format("Root mean square of the residual in multiples of the noise; * is more than noise leaves (p below {}). Excited "
                  "lines show what is "
                  "linear and not in the model, odd and even unexcited lines odd and even nonlinearity, dc an offset, skirts "
                  "(beside the excited "
                  "lines) a drift, the peak between the lines a tone.",
                  shown(limit, 2)));
}

void add_candidates(Page& page, const Record& record) {
  const auto names = record.texts("candidate_names");
  const std::vector<std::uint64_t> shape{names.size()};
  const Array *fit = record.array("candidate_fit_gain", shape), *p = record.array("candidate_p", shape),
              *select = record.array("candidate_select_gain", shape), *share = record.array("candidate_share", shape);
  if (names.empty() || fit == nullptr || p == nullptr || select == nullptr || share == nullptr) return;
  Table table{"Candidates, best first",
              {{"Effect", false},
               {"Fall of χ², fitted records"},
               {"p"},
               {"Fall of χ², selecting record"},
               {"Explains"},
               {"Why, or why not", false}},
              {}};
  for (std::size_t n = 0; n < names.size(); ++n) {
    table.rows.push_back({names[n], shown(fit->re[n], 4), shown(p->re[n], 2), shown(select->re[n], 4), percent(share->re[n]),
                          record.text_at("candidate_reasons", n, "")});
  }
  add_table(page.body(), table);
}

Series spectrum(const Array& frequency, const Array& level, const Array* kind, std::int64_t wanted, std::string name,
                int colour) {
  Series series;
  series.name = std::move(name);
  series.colour = colour;
  series.markers = kind != nullptr;
  series.line = kind == nullptr;
  for (std::size_t k = 1; k < frequency.size(); ++k) {
    const bool excited = kind != nullptr && kind->re[k] == 1.0;
    if (kind != nullptr && excited != (wanted == 1)) continue;
    series.x.push_back(frequency.re[k]);
    series.y.push_back(level.re[k] > 0.0 ? level.re[k] : kNaN);
  }
  return series;
}

/// The residual of the test record over frequency, before and after, with the noise.
void add_spectrum(Page& page, const Record& record) {
  const Array* frequency = record.array("frequency");
  if (frequency == nullptr || frequency->is_complex() || frequency->size() < 2) return;
  const Array *before = record.array("residual_before", frequency->shape),
              *after = record.array("residual_after", frequency->shape),
              *noise = record.array("residual_noise", frequency->shape), *kind = record.array("kind", frequency->shape);
  if (before == nullptr || after == nullptr || noise == nullptr || kind == nullptr) return;
  Chart chart;
  chart.name = record.key + "_residual";
  chart.title = "Residual on the test record";
  chart.description = "Root mean square of measured minus predicted output over frequency, before and after, with the noise.";
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = true;
  struct Part {
    const Array* level;
    const char* name;
    int colour;
  };
  for (const std::int64_t excited : {1, 0}) {
    Panel panel;
    panel.y = {Scale::logarithmic, 0, 1, {}, {}, with_unit(excited == 1 ? "Excited lines" : "Other lines", before->unit)};
    panel.height = 230.0;
    for (const Part& part : {Part{before, "before", 1}, Part{after, "after", 0}})
      panel.series.push_back(
          thinned(spectrum(*frequency, *part.level, kind, excited, excited == 1 ? part.name : "", part.colour), true));
    panel.series.push_back(thinned(spectrum(*frequency, *noise, nullptr, 0, excited == 1 ? "noise" : "", 5), true));
    chart.panels.push_back(std::move(panel));
  }
  page.figure(chart, "A right model leaves the noise: its lines scatter around the noise's root mean square.");
}

}  // namespace

bool add_trace(Page& page, const Record& record) {
  const std::string verdict = record.text("verdict"), finding = record.text("finding");
  if (verdict.empty()) return false;
  page.body().open("p").element("b", finding.empty() ? verdict_text(verdict) : finding).close("p");
  add_errors(page, record);
  add_effects(page, record);
  add_parameters(page, record);
  add_classes(page, record);
  add_candidates(page, record);
  add_spectrum(page, record);
  for (const auto& declared : record.texts("conventions")) page.paragraph("Declared: " + declared + ".");
  add_attributes(page, record,
                 {"verdict",
                  "finding",
                  "conventions",
                  "effects",
                  "error_before",
                  "error_after",
                  "error_remedied",
                  "noise_floor",
                  "noise_floor_99.9",
                  "warnings",
                  "parameter_names",
                  "parameter_units",
                  "effect_parameter_names",
                  "effect_parameter_units",
                  "class_names",
                  "class_records",
                  "class_p_limit",
                  "candidate_names",
                  "candidate_reasons",
                  "candidate_p_limit",
                  "candidate_select_limit"});
  return true;
}

bool add_reveal(Page& page, const Record& record) {
  const std::string sentence = record.text("sentence");
  if (sentence.empty()) return false;
  page.body().open("p").element("b", sentence).close("p");
  const Array* truth = record.array("parameters_true");
  if (truth == nullptr || truth->is_complex()) return true;
  const Array *before = record.array("parameters_before", truth->shape), *after = record.array("parameters_after", truth->shape),
              *std = record.array("parameters_after_std", truth->shape);
  if (before == nullptr || after == nullptr || std == nullptr) return true;
  Table table{
      "Parameters beside the true ones", {{"Parameter", false}, {"Before"}, {"After"}, {"std"}, {"True"}, {"Error / std"}}, {}};
  for (std::size_t n = 0; n < truth->size(); ++n) {
    table.rows.push_back({with_unit(record.text_at("parameter_names", n, fmt::format("parameter {}", n + 1)),
                                    record.text_at("parameter_units", n, "")),
                          shown(before->re[n], 6), shown(after->re[n], 6), shown(std->re[n], 3), shown(truth->re[n], 6),
                          shown((after->re[n] - truth->re[n]) / std->re[n], 2)});
  }
  add_table(page.body(), table);
  return true;
}

}  // namespace bodeflow::tools::report
