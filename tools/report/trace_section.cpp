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

}  // namespace

bool add_trace(Page& page, const Record& record) {
  const std::string verdict = record.text("verdict");
  if (verdict.empty()) return false;
  page.body().open("p").element("b", verdict_text(verdict)).close("p");
  const std::string unit = record.text("unit");
  std::vector<Bar> bars;
  struct Amount {
    const char* attribute;
    const char* name;
    int colour;
  };
  for (const Amount& level : {Amount{"error_before", "error before", 1}, Amount{"error_after", "with the effect", 0},
                              Amount{"error_remedied", "measured again", 2}, Amount{"noise_floor", "noise floor", 5}}) {
    const double value = record.number(level.attribute);
    if (std::isfinite(value) && value >= 0.0) bars.push_back({level.name, value, level.colour});
  }
  if (bars.size() > 1)
    page.figure(draw_bars("Error of the model", bars, unit, kWide), draw_bars("Error of the model", bars, unit, kNarrow),
                record.key + "_error", "");

  const auto effects = record.texts("effects");
  const Array* parameters = record.array("effect_parameters");
  const Array* deviations = parameters == nullptr ? nullptr : record.array("effect_parameter_std", parameters->shape);
  Table table{"Effects", {{"Effect", false}, {"Parameter"}, {"std"}}, {}};
  for (std::size_t n = 0; n < effects.size(); ++n) {
    const bool own = parameters != nullptr && parameters->size() == effects.size();
    table.rows.push_back({effects[n], own ? shown(parameters->re[n], parameters->unit, 6) : "–",
                          own && deviations != nullptr ? shown(deviations->re[n], 3) : "–"});
  }
  add_table(page.body(), table);
  add_attributes(page, record, {"verdict", "effects", "error_before", "error_after", "error_remedied", "noise_floor"});
  return true;
}

}  // namespace bodeflow::tools::report
