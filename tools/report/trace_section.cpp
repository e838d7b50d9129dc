#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/sections.hpp"
#include "report/trace_charts.hpp"

namespace bodeflow::tools::report {
namespace {

/// Attributes that have a place of their own on the page.
const std::vector<std::string> kShown{"verdict",
                                      "finding",
                                      "conventions",
                                      "effects",
                                      "effect_places",
                                      "effect_labels",
                                      "effect_equivalents",
                                      "equivalents",
                                      "effect_parameter_counts",
                                      "error_before",
                                      "error_after",
                                      "error_remedied",
                                      "noise_floor",
                                      "noise_floor_99.9",
                                      "noise_floor_0.01",
                                      "course_axis",
                                      "course_noise",
                                      "autocorrelation_band",
                                      "map_signals",
                                      "map_units",
                                      "floor_known",
                                      "periods",
                                      "input_name",
                                      "output_name",
                                      "excess_before",
                                      "excess_after",
                                      "warnings",
                                      "parameter_names",
                                      "parameter_units",
                                      "effect_parameter_names",
                                      "effect_parameter_units",
                                      "class_names",
                                      "class_records",
                                      "class_p_limit",
                                      "candidate_names",
                                      "candidate_effects",
                                      "candidate_reasons",
                                      "candidate_steps",
                                      "candidate_p_limit",
                                      "candidate_p_limits",
                                      "candidate_select_limit",
                                      "not_tried",
                                      "not_tried_reasons",
                                      "records",
                                      "record_checksums",
                                      "record_samples",
                                      "record_notes",
                                      "observations",
                                      "advice",
                                      "remarks",
                                      "unit",
                                      "partial_effects"};

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : between) + w;
  return text;
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
  const std::string unit = record.text("unit");
  const double highest = record.number("noise_floor_99.9"), less = record.number("excess_before"),
               rest = record.number("excess_after");
  const bool known = std::isfinite(record.number("noise_floor"));
  std::string text =
      "Root mean square on the test record, which was not used before, of the mean period within the band of the lines.";
  if (!known) text = "Root mean square on the test record, which was not used before. Its noise is not known.";
  if (known && std::isfinite(highest))
    text += " The noise alone stays below " + shown(highest, unit) + " with a probability of 99.9 %.";
  if (known && added && std::isfinite(less + rest))
    text += " What is not noise: " + shown(less, unit) + " before, " + shown(rest, unit) + " after.";
  page.figure(draw_bars("Error of the model", bars, unit, kWide), draw_bars("Error of the model", bars, unit, kNarrow),
              record.key + "_error", text);
}

void add_effects(Page& page, const Record& record) {
  const Array* values = record.array("effect_parameters");
  if (values == nullptr || values->is_complex()) return;
  const Array* deviations = record.array("effect_parameter_std", values->shape);
  const auto labels = record.texts("effect_labels");
  Table table{"Added: " + joined(labels.empty() ? record.texts("effects") : labels, " and "),
              {{"Parameter", false}, {"Value"}, {"std"}},
              {}};
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
  const bool added = !record.texts("effects").empty();
  Table table{"Parameters of the model", {{"Parameter", false}, {added ? "Before" : "Value"}, {"std"}}, {}};
  if (added) table.columns.insert(table.columns.end(), {{"After"}, {"std"}, {"Change"}});
  const auto std_at = [](const Array* std, std::size_t n) { return std == nullptr ? "–" : shown(std->re[n], 3); };
  for (std::size_t n = 0; n < before->size(); ++n) {
    std::vector<std::string> row{with_unit(record.text_at("parameter_names", n, fmt::format("parameter {}", n + 1)),
                                           record.text_at("parameter_units", n, before->unit)),
                                 shown(before->re[n], 6), std_at(before_std, n)};
    if (added) row.insert(row.end(), {shown(after->re[n], 6), std_at(after_std, n), percent(after->re[n] / before->re[n] - 1.0)});
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
}

/// What a class test says of a record: multiples of the noise and their p, before and after.
struct ClassRow {
  std::string record;
  const Array *before, *after, *p_before, *p_after;
  std::size_t begin;  ///< in the arrays
};

/// The records that were fitted and that selects, then the test record.
std::vector<ClassRow> class_rows(const Record& record, std::size_t classes) {
  const auto records = record.texts("class_records");
  std::vector<ClassRow> rows;
  const auto add = [&](const std::string& name, const char* prefix, const std::vector<std::uint64_t>& shape, std::size_t begin) {
    const std::string of = prefix;
    const ClassRow row{name,
                       record.array(of + "class_before", shape),
                       record.array(of + "class_after", shape),
                       record.array(of + "class_p_before", shape),
                       record.array(of + "class_p_after", shape),
                       begin};
    if (row.before != nullptr && row.after != nullptr && row.p_before != nullptr && row.p_after != nullptr) rows.push_back(row);
  };
  for (std::size_t r = 0; r < records.size(); ++r) add(records[r], "", {records.size(), classes}, r * classes);
  if (!rows.empty()) add("test", "test_", {classes}, 0);
  return rows;
}

void add_classes(Page& page, const Record& record) {
  const auto names = record.texts("class_names");
  const std::vector<ClassRow> rows = class_rows(record, names.size());
  if (names.empty() || rows.empty()) return;
  const double limit = record.number("class_p_limit");
  const bool added = !record.texts("effects").empty(), known = std::isfinite(record.number("noise_floor"));
  Table table{
      known ? "What is left, by class of lines, in multiples of the noise" : "What is left, by test", {{"Record", false}}, {}};
  if (added) table.columns.push_back({"Model", false});
  for (const auto& name : names) table.columns.push_back({name});
  for (const ClassRow& of : rows) {
    for (const bool late : added ? std::vector{false, true} : std::vector{false}) {
      std::vector<std::string> row{late ? "" : of.record};
      if (added) row.push_back(late ? "after" : "before");
      for (std::size_t c = 0; c < names.size(); ++c) {
        const bool found = (late ? of.p_after : of.p_before)->re[of.begin + c] < limit;
        row.push_back(shown((late ? of.after : of.before)->re[of.begin + c], 3) + (found ? " *" : ""));
      }
      table.rows.push_back(std::move(row));
    }
  }
  add_table(page.body(), table);
  if (!known) {
    page.paragraph(
        fmt::format("The noise is not known: * is a residual that does not look like noise (p below {}).", shown(limit, 2)));
    return;
  }
  page.paragraph(
      fmt::format("Root mean square of the residual in multiples of the noise; * is more than noise leaves (p below {}). Excited "
                  "lines show what is linear and not in the model, odd and even unexcited lines odd and even nonlinearity, dc an "
                  "offset, skirts (beside the excited lines) a drift, the peak between the lines a tone.",
                  shown(limit, 2)));
}

/// The same in the unit of the output.
void add_class_sizes(Page& page, const Record& record) {
  const auto names = record.texts("class_names"), records = record.texts("records");
  const std::vector<std::uint64_t> shape{records.size(), names.size()};
  const Array *before = record.array("class_rms_before", shape), *after = record.array("class_rms_after", shape),
              *noise = record.array("class_rms_noise", shape);
  if (names.empty() || before == nullptr || after == nullptr || noise == nullptr) return;
  const bool added = !record.texts("effects").empty();
  Table table{with_unit("What is left, by class of lines", before->unit), {{"Record", false}, {"", false}}, {}};
  for (const auto& name : names) table.columns.push_back({name});
  for (std::size_t r = 0; r < records.size(); ++r) {
    const auto add = [&](const std::string& record_name, const char* what, const Array& values) {
      std::vector<std::string> row{record_name, what};
      for (std::size_t c = 0; c < names.size(); ++c) row.push_back(shown(values.re[r * names.size() + c], 3));
      table.rows.push_back(std::move(row));
    };
    add(records[r], added ? "before" : "residual", *before);
    if (added) add("", "after", *after);
    add("", "noise", *noise);
  }
  add_table(page.body(), table);
  page.paragraph("Root mean square of all lines of a class together; of the peak that of the highest line.");
}

/// What each record was used for.
std::string use_of(const std::string& record) {
  return record.rfind("fit", 0) == 0 ? "fitted" : record == "select" ? "ranks the candidates" : "the errors told here";
}

/// The error of every record, also of those that were fitted.
void add_record_errors(Page& page, const Record& record) {
  const auto records = record.texts("records");
  const std::vector<std::uint64_t> shape{records.size()};
  const Array *before = record.array("record_error_before", shape), *after = record.array("record_error_after", shape),
              *noise = record.array("record_noise", shape);
  if (records.empty() || before == nullptr || after == nullptr || noise == nullptr) return;
  const bool added = !record.texts("effects").empty(), known = std::isfinite(noise->re.front());
  Table table{with_unit("Error by record", before->unit), {{"Record", false}, {added ? "Before" : "Error"}}, {}};
  if (added) table.columns.push_back({"After"});
  if (known) table.columns.insert(table.columns.end(), {{"Noise alone"}, {added ? "Before / noise" : "Error / noise"}});
  if (known && added) table.columns.push_back({"After / noise"});
  for (std::size_t n = 0; n < records.size(); ++n) {
    std::vector<std::string> row{records[n], shown(before->re[n])};
    if (added) row.push_back(shown(after->re[n]));
    if (known) row.insert(row.end(), {shown(noise->re[n]), shown(before->re[n] / noise->re[n], 3)});
    if (known && added) row.push_back(shown(after->re[n] / noise->re[n], 3));
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
}

void add_candidates(Page& page, const Record& record) {
  const auto names = record.texts("candidate_names");
  const std::vector<std::uint64_t> shape{names.size()};
  const Array *fit = record.array("candidate_fit_gain", shape), *p = record.array("candidate_p", shape),
              *select = record.array("candidate_select_gain", shape), *share = record.array("candidate_share", shape);
  if (names.empty() || fit == nullptr || p == nullptr || select == nullptr || share == nullptr) return;
  std::vector<double> steps;
  if (const auto found = record.attributes.find("candidate_steps"); found != record.attributes.end() && found->is_array())
    for (const auto& step : *found) steps.push_back(step.is_number() ? step.get<double>() : kNaN);
  Table table{"Candidates, best first",
              {{"Effect", false},
               {"Explains"},
               {"Why, or why not", false},
               {"Step"},
               {"Fall of χ², fitted"},
               {"p"},
               {"Fall of χ², selecting"}},
              {}};
  for (std::size_t n = 0; n < names.size(); ++n) {
    const double step = n < steps.size() ? steps[n] : 1.0;
    table.rows.push_back({names[n], percent(share->re[n]), record.text_at("candidate_reasons", n, ""), shown(step),
                          shown(fit->re[n], 4), shown(p->re[n], 2), shown(select->re[n], 4)});
  }
  add_table(page.body(), table);
  page.paragraph(
      "The fall of χ² is told for the fitted records, where p is the probability that chance does as well, and for the "
      "selecting record, which ranks.");
}

/// What the model leaves on records that were not fitted, in the unit of the output and in multiples of the noise.
void add_error_table(Page& page, const Record& record) {
  struct Row {
    std::string name;
    const char *error, *floor, *excess;
  };
  std::vector<Row> rows{{"model as declared, test record", "error_before", "noise_floor", "excess_before"}};
  if (!record.texts("effects").empty())
    rows.push_back(
        {"with " + joined(record.texts("effects"), " and ") + ", test record", "error_after", "noise_floor", "excess_after"});
  rows.push_back({"without it, measured with the remedy", "error_remedied", "noise_floor_remedied", "excess_remedied"});
  const std::string unit = record.text("unit");
  Table table{"Error on data not used for fitting",
              {{"Model", false},
               {with_unit("Error", unit)},
               {with_unit("Noise alone", unit)},
               {"Error / noise"},
               {with_unit("Not noise", unit)}},
              {}};
  for (const Row& row : rows) {
    const double error = record.number(row.error), floor = record.number(row.floor);
    if (!std::isfinite(error)) continue;
    table.rows.push_back({row.name, shown(error), shown(floor), shown(error / floor, 3), shown(record.number(row.excess), 3)});
  }
  if (table.rows.empty() || !std::isfinite(record.number("excess_before")) || !std::isfinite(record.number("noise_floor")))
    return;
  add_table(page.body(), table);
  page.paragraph("Root mean squares. What is not noise is the root of the difference of the squares of error and noise.");
}

/// Where noise alone puts the error, beside where it is.
void add_band(Page& page, const Record& record) {
  const double low = record.number("noise_floor_0.01"), high = record.number("noise_floor_99.9"),
               error = record.number(record.texts("effects").empty() ? "error_before" : "error_after");
  if (!std::isfinite(low) || !std::isfinite(high) || !std::isfinite(error)) return;
  const std::string unit = record.text("unit");
  page.paragraph("Noise alone puts the error on the test record between " + shown(low, unit) + " and " + shown(high, unit) +
                 " (it is higher once in 1,000 records and lower once in 10,000); it is " + shown(error, unit) + ", " +
                 (error > high  ? "above that band."
                  : error < low ? "below that band."
                                : "within that band."));
}

/// What can't be told from what was named, and what would tell it; warnings; what the experiment could not say.
void add_equivalents(Page& page, const Record& record) {
  const auto effects = record.texts("effects"), others = record.texts("effect_equivalents");
  for (std::size_t e = 0; e < effects.size() && e < others.size(); ++e)
    if (!others[e].empty()) page.note(effects[e] + " can't be told from " + others[e] + " with these data.");
  for (const char* list : {"warnings", "advice"})
    for (const std::string& text : record.texts(list)) page.note(text);
  for (const std::string& text : record.texts("remarks")) page.paragraph("On the test record: " + text + ".");
}

void add_not_tried(Page& page, const Record& record) {
  const auto names = record.texts("not_tried");
  if (names.empty()) return;
  open_details(page.body(), fmt::format("Effects of the catalogue that could not be tried: {}", names.size()));
  Table table{"", {{"Effect", false}, {"Why not", false}}, {}};
  for (std::size_t n = 0; n < names.size(); ++n) table.rows.push_back({names[n], record.text_at("not_tried_reasons", n, "")});
  add_table(page.body(), table);
  close_details(page.body());
}

/// What a trace is made of: records with what identifies them, and how they were prepared.
void add_records(Page& page, const Record& record) {
  const auto names = record.texts("records");
  if (names.empty()) return;
  const std::vector<std::uint64_t> shape{names.size()};
  const Array* levels = record.array("record_levels", shape);
  const auto samples = record.attributes.find("record_samples");
  const double periods = record.number("periods");
  Table table{"Records",
              {{"Record", false},
               {"Used for", false},
               {"Samples"},
               {with_unit("Input, rms", levels == nullptr ? "" : levels->unit)},
               {"Checksum", false}},
              {}};
  for (std::size_t n = 0; n < names.size(); ++n) {
    const bool told =
        samples != record.attributes.end() && samples->is_array() && n < samples->size() && (*samples)[n].is_number_unsigned();
    table.rows.push_back({names[n], use_of(names[n]), told ? counted((*samples)[n].get<std::uint64_t>()) : "–",
                          levels == nullptr || levels->re[n] == 0.0 ? "–" : shown(levels->re[n]),
                          record.text_at("record_checksums", n, "–").substr(0, 16)});
  }
  add_table(page.body(), table);
  if (periods > 0.0) page.paragraph("Periods that are averaged: " + shown(periods) + ".");
  page.paragraph(
      "All chances are drawn from fixed seeds: the same records give the same bits. Version, files and the seed of the "
      "run stand under Provenance.");
  for (const char* list : {"record_notes", "observations"})
    for (const std::string& text : record.texts(list)) page.paragraph(text);
}

/// A trace whose effects were remedied: what was switched on, the three errors, the residual.
bool add_remedied(Page& page, const Record& record) {
  page.body().open("p").element("b", record.text("remedy") + " " + record.text("sentence_remedied")).close("p");
  for (const std::string& warning : record.texts("warnings")) page.note(warning);
  add_error_table(page, record);
  add_remedied_residual(page, record);
  return true;
}

}  // namespace

bool add_trace(Page& page, const Record& record) {
  const std::string verdict = record.text("verdict"), finding = record.text("finding");
  if (verdict.empty()) return false;
  if (!record.text("remedy").empty()) return add_remedied(page, record);
  page.body().open("p").element("b", finding.empty() ? verdict_text(verdict) : finding).close("p");
  add_band(page, record);
  add_equivalents(page, record);
  add_error_table(page, record);
  add_effects(page, record);
  add_parameters(page, record);
  add_record_errors(page, record);
  add_classes(page, record);
  add_class_sizes(page, record);
  add_errors(page, record);
  add_trace_residual(page, record);
  add_trace_views(page, record);
  add_candidates(page, record);
  add_not_tried(page, record);
  add_records(page, record);
  for (const auto& declared : record.texts("conventions")) page.paragraph("Declared: " + declared + ".");
  add_attributes(page, record, kShown);
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
