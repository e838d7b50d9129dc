#include "reveal.hpp"

#include <algorithm>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string said(const Answer& a) {
  if (a.verdict == "none") return "nothing is missing";
  if (a.verdict == "unexplained") return "something is missing that it can't name";
  std::string text;
  for (const std::string& name : a.effects) text += (text.empty() ? "" : " and ") + name;
  for (const std::string& name : a.equivalents) text += " or " + name;
  return text + " is missing";
}

}  // namespace

bool is_right(const Answer& a, const std::string& hidden) {
  if (hidden == "none") return a.verdict == "none";
  const bool named = a.effects.size() == 1 && a.effects.front() == hidden;
  if (a.verdict == "named") return named;
  if (a.verdict == "not_separable") return named || holds(a.equivalents, hidden);
  return a.verdict == "unexplained" && !holds(a.candidates, hidden);
}

std::string comparison(const Answer& a, const std::string& hidden, double size, const std::string& unit) {
  const std::string truth =
      hidden == "none" ? "nothing" : hidden + " (" + records::short_number(size, 4) + (unit == "1" ? "" : " " + unit) + ")";
  return std::string(is_right(a, hidden) ? "Right" : "Wrong") + ": the bench hid " + truth + "; the trace said that " + said(a) +
         ".";
}

Eigen::Vector4d motor_truth(double rs, double rr, double ls, double lr, double lm) {
  const double sigma = ls - lm * lm / lr, alpha = rr / lr, lm_beta = lm * lm / (sigma * lr);
  return {rs / sigma + alpha * lm_beta, alpha, lm_beta, sigma};
}

}  // namespace bodeflow::residual
