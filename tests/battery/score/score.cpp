#include "score/score.hpp"

#include <algorithm>
#include <cmath>

#include "score/statistics.hpp"

namespace battery {
namespace {

bool holds(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool are_twins(const Twins& twins, const std::string& a, const std::string& b) {
  return std::any_of(twins.begin(), twins.end(),
                     [&](const auto& t) { return (t.first == a && t.second == b) || (t.first == b && t.second == a); });
}

std::string without_spaces(std::string unit) {
  std::erase_if(unit, [](char c) { return c == ' ' || c == '*'; });
  return unit;
}

/// p-values of what the base model leaves in clean cases, of every class of lines and every record.
std::vector<Uniformity> uniformity_of(const std::vector<Judged>& cases) {
  std::vector<double> all;
  std::map<std::string, std::vector<double>> classes;
  for (const Judged& j : cases) {
    const Answer& a = j.answer;
    const std::size_t columns = a.class_names.size();
    if (j.truth.kind != "clean" || a.class_p.size() != columns * a.class_records.size()) continue;
    for (std::size_t row = 0; row < a.class_records.size(); ++row) {
      for (std::size_t c = 0; c < columns; ++c) {
        const double p = a.class_p[row * columns + c];
        if (!std::isfinite(p)) continue;
        classes[a.class_names[c]].push_back(p);
        all.push_back(p);
      }
    }
  }
  std::vector<Uniformity> result;
  if (!all.empty()) result.push_back({"all", all.size(), uniform_probability(all)});
  for (const auto& [name, values] : classes) result.push_back({name, values.size(), uniform_probability(values)});
  return result;
}

void count_single(Score& s, const Judged& j, double limit, double visible) {
  const bool named = j.outcome == Outcome::right || j.outcome == Outcome::equivalent;
  ++s.single;
  s.wrong_names += j.outcome == Outcome::wrong;
  if (j.truth.size < limit) {
    ++s.below_limit;
    s.below_limit_wrong += j.outcome == Outcome::wrong;
  }
  if (j.truth.size >= visible) {
    ++s.visible;
    s.visible_named += named;
  }
  s.named_right += j.outcome == Outcome::right;
  s.named_as_equivalent += j.outcome == Outcome::equivalent;
  s.named_at_floor += named && j.answer.at_floor;
  for (const Checked& c : check_values(j)) {
    s.checked.push_back(c);
    s.covered += c.inside();
  }
}

}  // namespace

Outcome judge(const Truth& truth, const Answer& answer, const Twins& twins, const std::string& without) {
  if (answer.failed) return Outcome::failed;
  const std::string& v = answer.verdict;
  if (truth.kind == "clean") return v == "none" ? Outcome::right : Outcome::wrong;
  const bool stranger = truth.kind == "outside" || truth.effect == without;
  if (v == "none") return Outcome::silent;
  if (v == "unexplained") return stranger ? Outcome::right : Outcome::unexplained;
  if (truth.kind == "outside" || answer.effects.size() != 1) return Outcome::wrong;
  const std::string& named = answer.effects.front();
  if (named == truth.effect) return Outcome::right;
  return holds(answer.equivalents, truth.effect) || are_twins(twins, named, truth.effect) ? Outcome::equivalent : Outcome::wrong;
}

bool Checked::inside() const { return std::abs(value - truth) <= 1.959964 * std; }

std::vector<Checked> check_values(const Judged& j) {
  std::vector<Checked> all;
  const Answer& a = j.answer;
  if (j.outcome != Outcome::right || j.truth.kind != "single" || a.effects.size() != 1) return all;
  const std::size_t count =
      std::min({a.parameters.size(), a.parameter_std.size(), a.parameter_names.size(), a.parameter_units.size()});
  for (const Truth::Value& v : j.truth.values) {
    std::vector<std::size_t> same;
    for (std::size_t n = 0; n < count; ++n) {
      if (without_spaces(a.parameter_units[n]) == without_spaces(v.unit)) same.push_back(n);
    }
    if (same.size() > 1) std::erase_if(same, [&](std::size_t n) { return a.parameter_names[n] != v.name; });
    if (same.size() != 1 || !std::isfinite(a.parameter_std[same[0]]) || a.parameter_std[same[0]] <= 0.0) continue;
    all.push_back({j.truth.effect, v.name, v.value, a.parameters[same[0]], a.parameter_std[same[0]]});
  }
  return all;
}

Score count(const std::vector<Judged>& cases, double limit, double visible) {
  Score s;
  for (const Judged& j : cases) {
    s.failed += j.outcome == Outcome::failed;
    s.leaks += j.answer.leak;
    if (j.truth.kind == "single") {
      count_single(s, j, limit, visible);
    } else if (j.truth.kind == "outside") {
      ++s.outside;
      s.outside_not_unexplained += j.outcome != Outcome::right && j.outcome != Outcome::failed;
    } else {
      ++s.clean;
      s.false_alarms += j.outcome == Outcome::wrong;
    }
  }
  s.uniformity = uniformity_of(cases);
  return s;
}

}  // namespace battery
