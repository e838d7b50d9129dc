#include "trace_words.hpp"

#include <algorithm>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

using records::short_number;

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : between) + w;
  return text;
}

std::string errors(const Trace& t, const std::string& unit) {
  const auto with_unit = [&unit](double value) { return short_number(value, 4) + " " + unit; };
  if (!t.found) {
    return "Error on data not used for fitting: " + with_unit(t.before.error) + "; the noise alone leaves " +
           with_unit(t.before.floor) + " (99.9 %: below " + with_unit(t.before.highest) + ").";
  }
  return "Error on data not used for fitting: " + with_unit(t.before.error) + " -> " + with_unit(t.after.error) +
         "; the noise alone leaves " + with_unit(t.after.floor) + " (99.9 %: below " + with_unit(t.after.highest) + "); " +
         short_number(100.0 * t.candidates[*t.found].share, 3) + " % of what was missing is explained.";
}

std::string cause(const Trace& t) {
  const Candidate& c = t.candidates[*t.found];
  const auto own = static_cast<Eigen::Index>(c.effect->parameters().size());
  return c.effect->sentence(c.with.fit.values.tail(own), c.with.fit.std.tail(own), t.scales);
}

std::string nearest(const Trace& t) {
  if (t.candidates.empty()) return "The catalogue is empty.";
  const Candidate& c = t.candidates.front();
  return "The nearest candidate is " + c.name + ": it " + (c.reason.rfind("not physical", 0) == 0 ? "is " : "") + c.reason + ".";
}

}  // namespace

std::string remainder(const Trace& t) {
  std::vector<std::pair<std::string, double>> classes;  // largest multiple over the records, in the order of the tests
  for (const RecordTests& record : t.base.tests) {
    for (const ClassTest& test : record.classes) {
      if (test.p > t.levels.p_class) continue;
      const auto at = std::find_if(classes.begin(), classes.end(), [&](const auto& c) { return c.first == test.name; });
      if (at == classes.end()) {
        classes.emplace_back(test.name, test.multiple);
      } else {
        at->second = std::max(at->second, test.multiple);
      }
    }
  }
  std::vector<std::string> parts;
  for (const auto& [name, multiple] : classes) parts.push_back(name + " lines " + short_number(multiple, 3));
  return parts.empty() ? "" : joined(parts, ", ") + " times the noise";
}

std::string finding(const Trace& t, const std::string& unit) {
  switch (t.verdict) {
    case Verdict::none:
      return "Nothing is missing: what the model leaves is noise. " + errors(t, unit);
    case Verdict::named:
      return "Missing effect: " + cause(t) + ". " + errors(t, unit);
    case Verdict::not_separable:
      return "Missing effect: " + cause(t) + ", or, not to be told apart with these data, " + joined(t.equivalents, " or ") +
             ". " + errors(t, unit);
    case Verdict::unexplained:
      break;
  }
  if (t.found) {
    return "The error with " + t.candidates[*t.found].name +
           " is smaller than the noise allows: something of the measured output leaks into the model. Nothing is named. " +
           errors(t, unit);
  }
  const std::string rest = remainder(t);
  return "Something is missing that none of the known effects explains" + (rest.empty() ? "" : " (" + rest + ")") + ". " +
         nearest(t) + " " + errors(t, unit);
}

std::vector<std::string> warnings(const Trace& t) {
  std::vector<std::string> texts;
  if (!t.base.fit.converged) texts.push_back("the fit of the base model did not converge: check its declared hold and delay");
  if (t.found && !t.extended().fit.converged)
    texts.push_back("the fit with " + t.candidates[*t.found].name + " did not converge: its parameters are not the best ones");
  if (t.found && !t.after.at_floor()) {
    texts.push_back("the error on the test record is above what noise leaves: " + t.candidates[*t.found].name +
                    " is not all that is missing, or its law differs from the one assumed; look at the residual by class");
  }
  if (!t.separation.empty() && t.verdict == Verdict::not_separable)
    texts.push_back("to tell the equivalents apart, " + t.separation);
  return texts;
}

}  // namespace bodeflow::residual
