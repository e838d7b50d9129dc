#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/polynomial_text.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostRows = 200;

/// A real list of that length, or nullptr.
const Array* list_of(const Record& record, const char* name, std::size_t count) { return record.array(name, {count}); }

}  // namespace

bool add_monte_carlo(Page& page, const Record& record) {
  const Array* mean = record.array("mean");
  if (mean == nullptr || mean->is_complex() || mean->shape.size() != 1) return false;
  const std::size_t count = mean->size();
  const Array* deviation = list_of(record, "std", count);
  const Array* truth = list_of(record, "truth", count);
  const Array* published_mean = list_of(record, "published_mean", count);
  const Array* published_std = list_of(record, "published_std", count);
  const Array* predicted = list_of(record, "predicted_std", count);
  const Array* coverage = list_of(record, "coverage", count);
  const double runs = record.number("runs");
  add_attributes(page, record, {"quantity_names", "quantity_units"});

  Table table{"Over the runs", {{"Quantity", false}, {"Mean"}, {"std"}}, {}};
  if (predicted != nullptr) table.columns.push_back({"std that the runs state"});
  if (truth != nullptr) table.columns.insert(table.columns.end(), {{"Truth"}, {"Bias"}, {"Bias / its std"}});
  if (coverage != nullptr) table.columns.push_back({"Truth in the 95 % interval"});
  if (published_mean != nullptr) table.columns.push_back({"Published mean"});
  if (published_std != nullptr) table.columns.push_back({"Published std"});
  for (std::size_t n = 0; n < std::min(count, kMostRows); ++n) {
    const std::string unit = record.text_at("quantity_units", n, mean->unit);
    const double s = deviation == nullptr ? kNaN : deviation->re[n];
    std::vector<std::string> row{with_unit(record.text_at("quantity_names", n, fmt::format("quantity {}", n + 1)), unit),
                                 shown(mean->re[n], 6), shown(s, 3)};
    if (predicted != nullptr) row.push_back(shown(predicted->re[n], 3));
    if (truth != nullptr) {
      const double bias = mean->re[n] - truth->re[n];
      row.insert(row.end(), {shown(truth->re[n], 6), shown(bias, 3), shown(bias / (s / std::sqrt(runs)), 3)});
    }
    if (coverage != nullptr) row.push_back(percent(coverage->re[n]));
    if (published_mean != nullptr) row.push_back(shown(published_mean->re[n], 6));
    if (published_std != nullptr) row.push_back(shown(published_std->re[n], 3));
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
  if (truth != nullptr)
    page.paragraph("The bias divided by the standard deviation of the mean stays within about ±2 for an estimate without bias.");
  return true;
}

bool add_controller(Page& page, const Record& record) {
  const std::string variable = record.number("sample_time") > 0.0 ? "z" : "s";
  bool any = false;
  for (const char* name : {"R", "S", "T"}) {
    const Array* polynomial = record.array(name);
    any |= polynomial != nullptr && polynomial->shape.size() == 1 && !polynomial->is_complex();
  }
  if (!any) return false;
  if (const auto accepted = record.attributes.find("accepted"); accepted != record.attributes.end() && accepted->is_boolean()) {
    const std::string reason = record.text("reason");
    const std::string text = (accepted->get<bool>() ? "Accepted" : "Not accepted") + (reason.empty() ? "." : ": " + reason);
    if (accepted->get<bool>())
      page.paragraph(text);
    else
      page.note(text);
  }
  add_attributes(page, record, {"accepted", "reason"});
  for (const char* name : {"R", "S", "T"}) {
    const Array* polynomial = record.array(name);
    if (polynomial == nullptr || polynomial->shape.size() != 1 || polynomial->is_complex()) continue;
    page.body().element("p", {{"class", "poly"}},
                        fmt::format("{}({}) = {}", name, variable, polynomial_text(polynomial->re, variable)));
  }
  Table table{"Coefficients", {{"Polynomial", false}, {"Power"}, {"Coefficient"}}, {}};
  for (const char* name : {"R", "S", "T"}) {
    const Array* polynomial = record.array(name);
    if (polynomial == nullptr || polynomial->shape.size() != 1 || polynomial->is_complex()) continue;
    for (std::size_t n = 0; n < std::min(polynomial->size(), kMostRows); ++n)
      table.rows.push_back({name, std::to_string(polynomial->size() - 1 - n), shown(polynomial->re[n], 9)});
  }
  open_details(page.body(), "Coefficients");
  add_table(page.body(), table);
  close_details(page.body());
  return true;
}

bool add_sweep(Page& page, const Record& record) {
  const double runs_given = record.number("runs");
  if (!(runs_given >= 1.0 && runs_given <= 1e7)) return false;
  const auto runs = static_cast<std::size_t>(runs_given);
  std::vector<std::pair<std::string, const Array*>> columns;
  for (const auto& [name, array] : record.arrays)
    if (array.shape == std::vector<std::uint64_t>{runs} && !array.is_complex() && columns.size() < 24)
      columns.emplace_back(name, &array);
  if (columns.empty()) return false;
  std::stable_partition(columns.begin(), columns.end(), [](const auto& column) { return column.first.rfind("axis.", 0) == 0; });
  add_attributes(page, record, {});
  const auto title = [](const std::string& name) { return name.rfind("axis.", 0) == 0 ? name.substr(5) : name; };

  Table table{"Runs", {{"Run"}}, {}};
  for (const auto& [name, array] : columns) table.columns.push_back({with_unit(title(name), array->unit)});
  for (std::size_t n = 0; n < std::min(runs, kMostRows); ++n) {
    std::vector<std::string> row{std::to_string(n)};
    for (const auto& [name, array] : columns) row.push_back(shown(array->re[n], 6));
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
  if (runs > kMostRows) page.note(fmt::format("{} of {} runs are shown; all stand in result.json.", kMostRows, runs));
  add_sweep_charts(page, record, runs);
  return true;
}

}  // namespace bodeflow::tools::report
