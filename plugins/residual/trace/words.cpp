#include "trace/words.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

using records::short_number;

// Records whose levels differ by less are of one level.
constexpr double kTwoLevels = 1.2;
constexpr Eigen::Index kFewPeriods = 4;

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : between) + w;
  return text;
}

std::string percent(double part) { return short_number(100.0 * part, 3) + " %"; }

std::string errors(const Trace& t, const std::string& unit) {
  const auto with_unit = [&unit](double value) { return short_number(value, 4) + (unit.empty() ? "" : " " + unit); };
  std::string text = "Error on data not used for fitting: " + with_unit(t.before.error);
  if (t.added()) text += " -> " + with_unit(t.after.error);
  if (!t.floor_known) {
    text += "; the noise is not known from these records";
  } else {
    text += "; the noise alone leaves " + with_unit(t.after.floor) + " (99.9 %: below " + with_unit(t.after.highest) + ")";
  }
  if (t.added() && t.floor_known) text += "; " + percent(t.searched.share) + " of what was missing is explained";
  if (t.added() && !t.floor_known)
    text += "; " + percent(t.searched.share) + " of the squared error on the selecting record is gone";
  return text + ".";
}

/// The effect at `position` with its values, in words.
std::string sentence(const Trace& t, std::size_t position) {
  const Fit& f = t.searched.best.fit;
  const Addition& a = f.model.additions[position];
  const auto count = static_cast<Eigen::Index>(a.parameters.size());
  const Eigen::VectorXd values = f.values().segment(f.model.begin_of(position), count),
                        std = f.std().segment(f.model.begin_of(position), count);
  return a.effect->sentence({values.data(), a.parameters.size()}, {std.data(), a.parameters.size()}, a.situation);
}

std::string causes(const Trace& t) {
  const std::vector<Found>& found = t.searched.found;
  std::string text = found.size() > 1 ? "Missing effects: " : "Missing effect: ";
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (n > 0) text += n + 1 == found.size() ? "; and " : "; ";
    text += sentence(t, n);
    if (!found[n].equivalents.empty())
      text += ", or, not to be told apart with these data, " + joined(found[n].equivalents, " or ");
  }
  return text + ".";
}

std::string nearest(const Trace& t) {
  const Searched& s = t.searched;
  if (s.steps.empty() || s.steps.front().candidates.empty())
    return "No effect of the catalogue can be tried with this base model.";
  if (!s.found.empty()) {
    std::vector<std::string> labels;
    for (const Found& f : s.found) labels.push_back(f.addition.label);
    return "The nearest is " + joined(labels, " with ") + ", which explains " + percent(s.share) + " of it, needed above " +
           percent(s.levels.share) + ".";
  }
  const Candidate& c = s.steps.front().candidates.front();
  return "The nearest candidate is " + c.label + ": it " + (c.reason.rfind("not physical", 0) == 0 ? "is " : "") + c.reason + ".";
}

/// Whether the base model leaves more than noise between the lines of a record.
bool between_lines(const Trace& t) {
  for (const RecordTests& record : t.searched.base.tests)
    for (const ClassTest& test : record.classes)
      if ((test.name == "skirts" || test.name == "between") && !(test.p > t.searched.levels.p_class())) return true;
  return false;
}

}  // namespace

std::string remainder(const Trace& t) {
  std::vector<std::pair<std::string, double>> classes;  // largest multiple over the records, in the order of the tests
  for (const RecordTests& record : t.searched.base.tests) {
    for (const ClassTest& test : record.classes) {
      if (test.p > t.searched.levels.p_class()) continue;
      const auto at = std::find_if(classes.begin(), classes.end(), [&](const auto& c) { return c.first == test.name; });
      if (at == classes.end()) {
        classes.emplace_back(test.name, test.multiple);
      } else {
        at->second = std::max(at->second, test.multiple);
      }
    }
  }
  std::vector<std::string> parts;
  for (const auto& [name, multiple] : classes)
    parts.push_back(name + (t.floor_known ? " lines " : " ") + short_number(multiple, 3));
  return parts.empty() ? "" : joined(parts, ", ") + (t.floor_known ? " times the noise" : "");
}

std::string finding(const Trace& t, const std::string& unit) {
  switch (t.verdict) {
    case Verdict::none:
      return (t.floor_known ? "Nothing is missing: what the model leaves is noise. "
                            : "Nothing that is missing shows: what the model leaves looks like noise. ") +
             errors(t, unit);
    case Verdict::named:
    case Verdict::not_separable:
      return causes(t) + " " + errors(t, unit) +
             (t.floor_known ? "" : " Whether that is all can't be told where the noise floor is unknown.");
    case Verdict::unexplained:
      break;
  }
  if (!t.searched.found.empty() && t.after.leak()) {
    return "The error with " + t.searched.found.back().addition.label +
           " is smaller than the noise allows: something of the measured output leaks into the model. Nothing is named. " +
           errors(t, unit);
  }
  const std::string rest = remainder(t);
  if (t.searched.explains) {
    return "Something is missing that none of the known effects explains" + (rest.empty() ? "" : " (" + rest + ")") +
           ". The nearest is " + t.searched.found.back().addition.label +
           ", but with it the error on data not used at all does not fall. Nothing is named. " + errors(t, unit);
  }
  return "Something is missing that none of the known effects explains" + (rest.empty() ? "" : " (" + rest + ")") + ". " +
         nearest(t) + " " + errors(t, unit);
}

std::vector<std::string> warnings(const Trace& t) {
  std::vector<std::string> texts;
  const Searched& s = t.searched;
  if (!s.base.fit.converged) texts.push_back("the fit of the base model did not converge: check its declared hold and delay");
  if (t.added() && !s.best.fit.converged)
    texts.push_back("the fit with " + s.found.back().addition.label +
                    " did not converge: its parameters are not the best ones; give more data or a simpler base");
  if (t.added() && t.floor_known && !t.after.at_floor()) {
    texts.push_back("the error on the test record is above what noise leaves: " + s.found.back().addition.label +
                    " is not all that is missing, or its law differs from the one assumed; look at the residual by class");
  }
  for (const Found& f : s.found)
    if (t.added() && !f.equivalents.empty() && !f.separation.empty())
      texts.push_back("to tell " + f.addition.label + " from " + joined(f.equivalents, " and ") + ", " + f.separation);
  return texts;
}

std::vector<std::string> advice(const Trace& t, const TraceData& data) {
  std::vector<std::string> texts;
  double low = data.fit.front()->facts().level, high = low;
  bool periodic = true, response = false;
  Eigen::Index periods = data.fit.front()->facts().periods;
  for (const auto& r : data.fit) {
    low = std::min(low, r->facts().level);
    high = std::max(high, r->facts().level);
    periodic = periodic && r->facts().periods > 0;
    response = response || r->facts().sample_rate_hz <= 0.0;
    periods = std::min(periods, r->facts().periods);
  }
  const bool one_level = !(high > kTwoLevels * low);
  if (!response && one_level) {
    texts.push_back(
        "the fitted records are of one level: what grows or shrinks with it is told from linear dynamics by lines that are not "
        "excited alone, if there are any; measure at a second level, half of this one");
  }
  if (response) texts.push_back("measured responses show linear effects only; give recordings of two levels for the others");
  if (periodic && periods > 0 && periods < kFewPeriods)
    texts.push_back("with " + std::to_string(periods) + " periods the noise floor is uncertain; measure 6 or more");
  if (periodic && periods > 0 && !response) {
    bool odd = false;
    for (const RecordTests& r : t.searched.base.tests)
      for (const ClassTest& c : r.classes) odd = odd || c.name == "odd";
    if (!odd) texts.push_back("all odd lines are excited: leave some out, so that odd nonlinearities show on them");
  }
  if (periodic && periods > 0 && !response && t.verdict == Verdict::unexplained && between_lines(t))
    texts.push_back(
        "what is left stands between the lines too, where a steady periodic excitation leaves noise alone: check that the period "
        "is right, and skip more periods in case the first one still holds the transient");
  if (!periodic && !response)
    texts.push_back("the noise floor of a record that is not periodic is unknown; repeat a period 6 times to know it");
  return texts;
}

}  // namespace bodeflow::residual
