#include "score/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "score/statistics.hpp"

namespace battery {
namespace {

std::string number(double value, const char* form = "%.3g") {
  if (!std::isfinite(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

std::string row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const auto& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string text = row(head) + row(std::vector<std::string>(head.size(), "---"));
  for (const auto& cells : rows) text += row(cells);
  return text + "\n";
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// What an answer says, as a column of the confusion matrix.
std::string said(const Judged& j) {
  if (j.outcome == Outcome::failed) return "failed";
  if (j.answer.verdict == "none" || j.answer.verdict == "unexplained") return j.answer.verdict;
  if (j.outcome == Outcome::equivalent) return j.truth.effect;  // a declared equivalent counts as right
  return j.answer.effects.empty() ? j.answer.verdict : joined(j.answer.effects, " + ");
}

std::string hidden(const Judged& j) { return (j.truth.kind == "outside" ? "outside: " : "") + j.truth.effect; }

std::string confusion(const std::vector<Judged>& cases) {
  std::set<std::string> named;
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, int> all;
  for (const Judged& j : cases) {
    const std::string column = said(j);
    if (column != "none" && column != "unexplained" && column != "failed") named.insert(column);
    ++counts[hidden(j)][column];
    ++all[hidden(j)];
  }
  std::vector<std::string> columns{"none", "unexplained"};
  columns.insert(columns.end(), named.begin(), named.end());
  if (std::any_of(cases.begin(), cases.end(), [](const Judged& j) { return j.outcome == Outcome::failed; }))
    columns.push_back("failed");
  std::vector<std::string> head{"hidden", "cases"};
  head.insert(head.end(), columns.begin(), columns.end());
  std::vector<std::vector<std::string>> rows;
  // The clean cases first, strangers last.
  for (const int part : {0, 1, 2}) {
    for (const auto& [effect, count] : all) {
      if ((effect == "none" ? 0 : effect.rfind("outside: ", 0) == 0 ? 2 : 1) != part) continue;
      std::vector<std::string> cells{effect, std::to_string(count)};
      for (const auto& column : columns) {
        const int found = counts[effect][column];
        cells.push_back(found == 0 ? "" : column == effect ? "**" + std::to_string(found) + "**" : std::to_string(found));
      }
      rows.push_back(cells);
    }
  }
  return table(head, rows);
}

std::string sizes(const std::vector<Judged>& cases) {
  const std::vector<double> borders{0.0, 0.03, 0.1, 0.3, 1.0, 3.0, INFINITY};
  std::vector<std::vector<std::string>> rows;
  for (std::size_t b = 0; b + 1 < borders.size(); ++b) {
    int all = 0, right = 0, silent = 0, unexplained = 0, wrong = 0;
    std::vector<double> before, after;
    for (const Judged& j : cases) {
      if (j.truth.kind != "single" || j.truth.size < borders[b] || j.truth.size >= borders[b + 1]) continue;
      ++all;
      silent += j.outcome == Outcome::silent;
      unexplained += j.outcome == Outcome::unexplained;
      wrong += j.outcome == Outcome::wrong;
      if (j.outcome != Outcome::right && j.outcome != Outcome::equivalent) continue;
      ++right;
      before.push_back(j.answer.error_before / j.answer.floor);
      after.push_back(j.answer.error_after / j.answer.floor);
    }
    rows.push_back({number(borders[b]) + " to " + (std::isfinite(borders[b + 1]) ? number(borders[b + 1]) : "more"),
                    std::to_string(all), std::to_string(right), std::to_string(silent), std::to_string(unexplained),
                    std::to_string(wrong), number(median(before)), number(median(after), "%.4g")});
  }
  return table(
      {"model error / noise", "cases", "named right", "none", "unexplained", "wrong", "error before / floor", "after / floor"},
      rows);
}

std::string parameters(const Score& s) {
  std::map<std::string, std::vector<Checked>> groups;
  for (const Checked& c : s.checked) groups[c.effect + ": " + c.name].push_back(c);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, list] : groups) {
    std::vector<double> errors, multiples;
    long inside = 0;
    for (const Checked& c : list) {
      errors.push_back(std::abs(c.value / c.truth - 1.0));
      multiples.push_back(std::abs(c.value - c.truth) / c.std);
      inside += c.inside();
    }
    rows.push_back({name, std::to_string(list.size()), std::to_string(inside), number(100.0 * median(errors)) + " %",
                    number(median(multiples))});
  }
  return table({"parameter", "named cases", "truth in the 95 % interval", "median error", "median error / std (0.67 is right)"},
               rows);
}

std::string p_values(const std::vector<Judged>& cases, const Score& s) {
  std::vector<std::vector<std::string>> rows;
  for (const Uniformity& u : s.uniformity) rows.push_back({u.name, std::to_string(u.count), number(u.p)});
  std::string text = table({"class of lines", "p-values", "Kolmogorov-Smirnov p"}, rows);
  std::map<std::string, std::vector<double>> candidates;
  for (const Judged& j : cases) {
    for (std::size_t n = 0; j.truth.kind == "clean" && n < std::min(j.answer.candidate_names.size(), j.answer.candidate_p.size());
         ++n) {
      if (std::isfinite(j.answer.candidate_p[n])) candidates[j.answer.candidate_names[n]].push_back(j.answer.candidate_p[n]);
    }
  }
  rows.clear();
  for (const auto& [name, p] : candidates) {
    const auto share = [&, &values = p](double level) {
      return number(100.0 *
                    static_cast<double>(std::count_if(values.begin(), values.end(), [=](double v) { return v <= level; })) /
                    static_cast<double>(values.size()));
    };
    rows.push_back(
        {name, std::to_string(p.size()), share(0.5), share(0.1), share(0.01), number(*std::min_element(p.begin(), p.end()))});
  }
  return text +
         table({"candidate in clean cases", "p-values", "below 0.5 [%]", "below 0.1 [%]", "below 0.01 [%]", "least"}, rows);
}

std::string misses(const std::vector<Judged>& cases) {
  std::vector<std::vector<std::string>> rows;
  for (const Judged& j : cases) {
    const bool bad = j.outcome == Outcome::wrong || j.outcome == Outcome::failed ||
                     (j.truth.kind == "outside" && j.outcome == Outcome::silent);
    if (!bad && !j.answer.leak) continue;
    rows.push_back({j.truth.number, j.truth.plant, hidden(j), number(j.truth.size),
                    (j.outcome == Outcome::failed ? "failed " + j.answer.message : said(j)) + (j.answer.leak ? ", leak" : ""),
                    joined(j.answer.equivalents, ", "), number(j.answer.error_before / j.answer.floor),
                    number(j.answer.error_after / j.answer.floor)});
  }
  return table({"case", "plant", "hidden", "size", "answer", "equivalents", "before / floor", "after / floor"}, rows);
}

Check at_most(const std::string& what, int found, int all, int limit) {
  const bool asked = limit != std::numeric_limits<int>::max();
  return {what,
          std::to_string(found) + " of " + std::to_string(all) +
              " (95 % limit of the rate: " + number(100.0 * upper_rate(found, all)) + " %)",
          asked ? "at most " + std::to_string(limit) : "", found <= limit};
}

Check share_of(const std::string& what, int found, int all, double least) {
  const double share = all ? static_cast<double>(found) / all : std::nan("");
  return {what, std::to_string(found) + " of " + std::to_string(all),
          least > 0.0 ? "at least " + number(100.0 * least) + " %" : "", !(least > 0.0) || !all || share >= least};
}

}  // namespace

std::vector<Check> checks_of(const Score& s, const Limits& limits, double limit, double visible) {
  const int all = s.clean + s.single + s.outside;
  std::vector<Check> checks;
  checks.push_back(at_most("false alarms in clean cases", s.false_alarms, s.clean, limits.false_alarms));
  checks.push_back(at_most("wrong names in single-effect cases", s.wrong_names, s.single, limits.wrong_names));
  checks.push_back(at_most("outside cases not unexplained", s.outside_not_unexplained, s.outside, limits.outside));
  checks.push_back(share_of("no wrong name below " + number(limit) + " x noise", s.below_limit - s.below_limit_wrong,
                            s.below_limit, limits.silent_share));
  checks.push_back(share_of("named from " + number(visible) + " x noise on", s.visible_named, s.visible, limits.named_share));
  const int checked = static_cast<int>(s.checked.size());
  const double coverage = checked ? static_cast<double>(s.covered) / checked : std::nan("");
  const bool asked = limits.coverage_low > 0.0 || limits.coverage_high < 1.0;
  checks.push_back({"true parameter in the 95 % interval",
                    std::to_string(s.covered) + " of " + std::to_string(checked) + " = " + number(coverage),
                    asked ? number(limits.coverage_low) + " to " + number(limits.coverage_high) : "",
                    !asked || (coverage >= limits.coverage_low && coverage <= limits.coverage_high)});
  const double p = s.uniformity.empty() ? std::nan("") : s.uniformity.front().p;
  checks.push_back({"clean p-values uniform (Kolmogorov-Smirnov p)", number(p),
                    limits.uniformity > 0.0 ? "above " + number(limits.uniformity) : "",
                    !(limits.uniformity > 0.0) || p > limits.uniformity});
  checks.push_back(at_most("leaks", s.leaks, all, limits.leaks));
  checks.push_back(at_most("cases without an answer", s.failed, all, limits.failed));
  checks.push_back(share_of("held-out error at the floor, of those named right", s.named_at_floor,
                            s.named_right + s.named_as_equivalent, 0.0));
  return checks;
}

std::string report(const std::vector<Judged>& cases, const Score& s, const std::vector<Check>& checks) {
  std::vector<std::vector<std::string>> rows;
  for (const Check& c : checks) rows.push_back({c.what, c.found, c.asked, c.asked.empty() ? "" : c.passed ? "yes" : "**no**"});
  std::string text = "# Blind battery: " + std::to_string(s.clean) + " clean, " + std::to_string(s.single) + " single-effect, " +
                     std::to_string(s.outside) + " outside cases\n\n";
  text += table({"", "found", "asked", "met"}, rows);
  text += "Named right " + std::to_string(s.named_right) + ", as a declared equivalent " + std::to_string(s.named_as_equivalent) +
          ".\n\n";
  text += "## Hidden (rows) and answered (columns)\n\n" + confusion(cases);
  text += "## By size\n\n" + sizes(cases);
  text += "## Parameters\n\n" + parameters(s);
  text += "## p-values in clean cases\n\n" + p_values(cases, s);
  return text + "## Cases answered wrongly\n\n" + misses(cases);
}

}  // namespace battery
