#include <fmt/format.h>

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <cmath>
#include <numbers>

#include "report/bode.hpp"
#include "report/levels.hpp"
#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kTableLines = 12;
constexpr std::size_t kWorstLines = 5;

std::string form_text(const std::string& form) {
  if (form == "errors_in_variables") return "errors in variables (noise on input and output)";
  if (form == "known_input") return "known input (noise on the output)";
  if (form == "reference") return "by the reference (closed loop)";
  if (form == "h1") return "H1 (noise on the output)";
  if (form == "h2") return "H2 (noise on the input)";
  if (form == "hv") return "Hv (noise on both)";
  if (form == "local_polynomial") return "local polynomial method";
  if (form == "stepped_sine") return "stepped sine";
  if (form == "imported") return "imported from a file";
  return form;
}

/// sqrt(variance) / |G| of every line of a pair.
std::vector<double> relative_deviations(const Response& response, std::size_t i, std::size_t j) {
  std::vector<double> relative;
  for (std::size_t k = 0; k < response.lines(); ++k) {
    const double size = std::abs(response.value(k, i, j));
    relative.push_back(size > 0.0 ? std::sqrt(response.variance(k, i, j)) / size : kNaN);
  }
  return relative;
}

void add_main_figures(Page& page, const Response& response) {
  const Record& record = *response.record;
  Facts facts;
  facts.emplace_back("Lines", counted(response.lines()));
  facts.emplace_back("Band", fmt::format("{} – {} Hz", shown(response.frequency.front()), shown(response.frequency.back())));
  const auto add = [&](const char* title, const char* name, const std::string& unit = "") {
    const double value = record.number(name);
    if (std::isfinite(value)) facts.emplace_back(title, shown(value, unit, 6));
  };
  add("Periods", "periods");
  add("Realisations", "realisations");
  if (std::isfinite(response.degrees_of_freedom)) facts.emplace_back("Degrees of freedom", shown(response.degrees_of_freedom));
  add("Sample rate", "sample_rate", "Hz");
  add("Period", "period", "samples");
  add("Dropped", "dropped_samples", "samples");
  if (!record.text("form").empty()) facts.emplace_back("Form", form_text(record.text("form")));
  if (!record.text("method").empty()) facts.emplace_back("Method", record.text("method"));
  for (auto& fact : facts_of(record, {"form", "method", "periods", "realisations", "sample_rate", "period", "dropped_samples",
                                      "degrees_of_freedom", "confidence", "input_names", "output_names", "response_units"}))
    facts.push_back(std::move(fact));
  add_facts(page.body(), facts);
}

void add_pair_table(Page& page, const Response& response) {
  Table table{
      "Uncertainty",
      {{"Output / input", false}, {"Unit", false}, {"Median relative std"}, {"Largest"}, {"at [Hz]"}, {"Lines that may be zero"}},
      {}};
  for (std::size_t i = 0; i < response.outputs; ++i)
    for (std::size_t j = 0; j < response.inputs && table.rows.size() < kMostPairs; ++j) {
      const auto relative = relative_deviations(response, i, j);
      const auto worst =
          std::max_element(relative.begin(), relative.end(), [](double a, double b) { return std::isnan(a) || a < b; });
      const std::size_t at = static_cast<std::size_t>(worst - relative.begin());
      std::size_t zero = 0;
      for (std::size_t k = 0; k < response.lines(); ++k)
        zero += response.radius(k, i, j) >= std::abs(response.value(k, i, j)) ? 1 : 0;
      table.rows.push_back({response.pair_name(i, j), response.unit(i, j), percent(median(relative)), percent(*worst),
                            std::isfinite(*worst) ? shown(response.frequency[at]) : "–", counted(zero)});
    }
  add_table(page.body(), table);
}

struct Line {
  std::size_t k, i, j;
  double relative;
};

void add_worst_lines(Page& page, const Response& response) {
  std::vector<Line> worst;
  const auto before = [](const Line& a, const Line& b) { return a.relative > b.relative; };
  for (std::size_t i = 0; i < response.outputs; ++i)
    for (std::size_t j = 0; j < response.inputs; ++j) {
      const auto relative = relative_deviations(response, i, j);
      for (std::size_t k = 0; k < relative.size(); ++k) {
        if (!(relative[k] > 0.0) || (worst.size() == kWorstLines && relative[k] <= worst.back().relative)) continue;
        worst.push_back({k, i, j, relative[k]});
        std::sort(worst.begin(), worst.end(), before);
        if (worst.size() > kWorstLines) worst.pop_back();
      }
    }
  Table table{"Least certain lines", {{"f [Hz]"}, {"Output / input", false}, {"|G|"}, {"Relative std"}}, {}};
  for (const auto& line : worst)
    table.rows.push_back({shown(response.frequency[line.k]), response.pair_name(line.i, line.j),
                          shown(std::abs(response.value(line.k, line.i, line.j))), percent(line.relative)});
  add_table(page.body(), table);
}

/// At most kTableLines lines, evenly spread over the logarithm of the frequency.
std::vector<std::size_t> spread_lines(const Response& response) {
  std::vector<std::size_t> lines;
  const std::size_t count = response.lines();
  if (count <= kTableLines) {
    for (std::size_t k = 0; k < count; ++k) lines.push_back(k);
    return lines;
  }
  const auto& f = response.frequency;
  const double low = std::max(f.front(), f[1] > 0.0 ? std::min(f[1], f.back() * 1e-6) : 1e-300), high = f.back();
  for (std::size_t n = 0; n < kTableLines; ++n) {
    const double wanted = low > 0.0 && high > low ? low * std::pow(high / low, static_cast<double>(n) / (kTableLines - 1)) : high;
    const auto next = std::min<std::ptrdiff_t>(std::lower_bound(f.begin(), f.end(), wanted * (1.0 - 1e-9)) - f.begin(),
                                               static_cast<std::ptrdiff_t>(count) - 1);
    if (lines.empty() || lines.back() != static_cast<std::size_t>(next)) lines.push_back(static_cast<std::size_t>(next));
  }
  return lines;
}

std::vector<CsvColumn> csv_columns(const Response& response) {
  std::vector<CsvColumn> columns{{"f [Hz]", response.frequency}};
  for (std::size_t i = 0; i < response.outputs; ++i)
    for (std::size_t j = 0; j < response.inputs; ++j) {
      const std::string name = response.pair_name(i, j), unit = response.unit(i, j);
      CsvColumn re{fmt::format("re({}) [{}]", name, unit), {}}, im{fmt::format("im({}) [{}]", name, unit), {}};
      CsvColumn deviation{fmt::format("std({}) [{}]", name, unit), {}}, radius{fmt::format("radius({}) [{}]", name, unit), {}};
      for (std::size_t k = 0; k < response.lines(); ++k) {
        re.values.push_back(response.value(k, i, j).real());
        im.values.push_back(response.value(k, i, j).imag());
        deviation.values.push_back(std::sqrt(response.variance(k, i, j)));
        radius.values.push_back(response.radius(k, i, j));
      }
      columns.insert(columns.end(), {std::move(re), std::move(im), std::move(deviation), std::move(radius)});
    }
  return columns;
}

void add_numbers(Page& page, const Response& response) {
  constexpr std::size_t kMostCsv = 40000;  // lines x pairs: more would not fit on the page anyway
  open_details(page.body(), "Numbers");
  Table table{fmt::format("{} of {} lines", spread_lines(response).size(), response.lines()),
              {{"f [Hz]"},
               {"Output / input", false},
               {"|G|"},
               {"|G| [dB]"},
               {"Phase [°]"},
               {"std of G"},
               {percent(response.confidence) + " radius"}},
              {}};
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < response.outputs; ++i)
    for (std::size_t j = 0; j < response.inputs && pairs < kMostPairs; ++j, ++pairs)
      for (const std::size_t k : spread_lines(response)) {
        const auto g = response.value(k, i, j);
        table.rows.push_back({shown(response.frequency[k]), response.pair_name(i, j), shown(std::abs(g), 5),
                              shown(decibel(std::abs(g))), shown(std::arg(g) * 180.0 / std::numbers::pi),
                              shown(std::sqrt(response.variance(k, i, j)), 3), shown(response.radius(k, i, j), 3)});
      }
  add_table(page.body(), table);
  if (response.lines() * response.outputs * response.inputs <= kMostCsv)
    page.csv(response.record->key, csv_columns(response));
  else
    page.paragraph(fmt::format("All {} lines stand in result.json: too many for this page.", counted(response.lines())));
  close_details(page.body());
}

std::string band_caption(const Response& response) {
  if (response.of_pairs("variance") == nullptr && response.of_pairs("confidence_radius") == nullptr)
    return "The record tells no uncertainty.";
  if (response.of_pairs("confidence_radius") != nullptr)
    return fmt::format(
        "Shaded: {} confidence region of each line by itself; where it holds zero the phase is not known and not drawn",
        percent(response.confidence));
  if (std::isfinite(response.degrees_of_freedom))
    return fmt::format("Shaded: {} confidence region of each line by itself, from the variance with {} degrees of freedom",
                       percent(response.confidence), shown(response.degrees_of_freedom));
  return "The record does not tell its degrees of freedom: no confidence region can be drawn.";
}

void add_bode_plots(Page& page, const Response& response) {
  add_main_figures(page, response);
  if (response.outputs * response.inputs > kMostPairs)
    page.note(fmt::format("Of {} pairs of output and input {} are drawn; all stand in result.json.",
                          response.outputs * response.inputs, kMostPairs));
  for (const auto& chart : bode_charts(response, nullptr)) page.figure(chart, band_caption(response));
}

}  // namespace

bool add_bode_plots(Page& page, const Record& record) {
  const auto response = read_response(record);
  if (response) add_bode_plots(page, *response);
  return response.has_value();
}

bool add_frequency_response(Page& page, const Record& record) {
  const auto response = read_response(record);
  if (!response) return false;
  add_bode_plots(page, *response);
  if (response->of_pairs("variance") != nullptr) {
    page.heading("How sure it is");
    page.grid(uncertainty_charts(*response),
              "Standard deviation of the complex estimate, E|dG|² = std². Where it comes near |G| the line tells little.");
    add_pair_table(page, *response);
    add_worst_lines(page, *response);
  }
  if (const auto levels = level_charts(*response); !levels.empty()) {
    page.heading("Noise and distortion");
    page.grid(
        levels,
        "Where distortion stands well above the noise, the response is the best linear approximation at this amplitude alone.");
  }
  add_curves(page, record, {"frequency", "line"}, record.array("frequency")->size());
  add_numbers(page, *response);
  return true;
}

}  // namespace bodeflow::tools::report
