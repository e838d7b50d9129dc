#include "blocks/reveal.hpp"

#include <algorithm>

#include "trace/remedy.hpp"

namespace bodeflow::residual {
namespace {

std::string without_place(const std::string& label) { return label.substr(0, label.find(" at ")); }

bool holds(const std::vector<std::string>& labels, const std::string& name) {
  return std::any_of(labels.begin(), labels.end(), [&](const std::string& label) { return without_place(label) == name; });
}

/// Whether each of the effects that were named can be given to a hidden one of its own.
bool all_named(const Answer& a, const std::vector<HiddenTruth>& hidden) {
  if (a.effects.size() != hidden.size()) return false;
  std::vector<std::string> open = a.effects;
  std::vector<std::string> missing;
  for (const HiddenTruth& truth : hidden) {
    const auto at = std::find_if(open.begin(), open.end(), [&](const auto& label) { return without_place(label) == truth.name; });
    if (at != open.end()) {
      open.erase(at);
    } else {
      missing.push_back(truth.name);
    }
  }
  return missing.empty() || (a.verdict == "not_separable" && std::all_of(missing.begin(), missing.end(), [&](const auto& name) {
                               return holds(a.equivalents, name);
                             }));
}

std::string listed(const std::vector<HiddenTruth>& hidden) {
  std::string text;
  for (const HiddenTruth& h : hidden) {
    text += (text.empty() ? "" : " and ") + h.name + " (" + amount_text(h.size, h.unit) + ")";
  }
  return text.empty() ? "nothing" : text;
}

std::string said(const Answer& a) {
  if (a.verdict == "none") return "nothing is missing";
  if (a.verdict == "unexplained") return "something is missing that it can't name";
  std::string text;
  for (const std::string& name : a.effects) text += (text.empty() ? "" : " and ") + name;
  for (const std::string& name : a.equivalents) text += " or " + name;
  return text + (a.effects.size() > 1 && a.equivalents.empty() ? " are missing" : " is missing");
}

}  // namespace

bool is_right(const Answer& a, const std::vector<HiddenTruth>& hidden) {
  if (hidden.empty()) return a.verdict == "none";
  if (a.verdict == "named" || a.verdict == "not_separable") return all_named(a, hidden);
  return a.verdict == "unexplained" &&
         !std::all_of(hidden.begin(), hidden.end(), [&](const HiddenTruth& h) { return holds(a.candidates, h.name); });
}

std::string comparison(const Answer& a, const std::vector<HiddenTruth>& hidden) {
  return std::string(is_right(a, hidden) ? "Right" : "Wrong") + ": the bench hid " + listed(hidden) + "; the trace said that " +
         said(a) + ".";
}

Eigen::Vector4d motor_truth(double rs, double rr, double ls, double lr, double lm) {
  const double sigma = ls - lm * lm / lr, alpha = rr / lr, lm_beta = lm * lm / (sigma * lr);
  return {rs / sigma + alpha * lm_beta, alpha, lm_beta, sigma};
}

}  // namespace bodeflow::residual
