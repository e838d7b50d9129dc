#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "score/answer.hpp"

namespace battery {

enum class Outcome {
  right,        ///< none for a clean case, the effect's name, unexplained for a stranger
  equivalent,   ///< the effect stands among what the answer says it can't tell apart
  silent,       ///< none, where something was hidden
  unexplained,  ///< where the catalogue has the effect
  wrong,        ///< a finding in a clean case, another or a further name, a name for a stranger
  failed        ///< no answer
};

/// Names that no measurement of this kind tells apart, besides what an answer declares.
using Twins = std::vector<std::pair<std::string, std::string>>;

struct Judged {
  Truth truth;
  Answer answer;
  Outcome outcome = Outcome::failed;
};

/// With `without`, the effect was not in the tracer's catalogue: then a stranger's answer is the right one.
Outcome judge(const Truth& truth, const Answer& answer, const Twins& twins, const std::string& without);

/// A parameter of a rightly named effect beside its true value.
struct Checked {
  std::string effect, name;
  double truth = 0.0, value = 0.0, std = 0.0;
  bool inside() const;  ///< the 95 % interval has the truth in it
};
std::vector<Checked> check_values(const Judged& j);

struct Uniformity {
  std::string name;
  std::size_t count = 0;
  double p = 0.0;  ///< of Kolmogorov and Smirnov
};

struct Score {
  int clean = 0, single = 0, outside = 0;
  int false_alarms = 0, wrong_names = 0, outside_not_unexplained = 0, failed = 0, leaks = 0;
  int named_right = 0, named_as_equivalent = 0, named_at_floor = 0;
  int below_limit = 0, below_limit_wrong = 0;  ///< effects that are smaller than what can be seen
  int visible = 0, visible_named = 0;          ///< of at least the size from which on 95 % are to be named
  std::vector<Checked> checked;
  int covered = 0;
  std::vector<Uniformity> uniformity;  ///< of p-values in clean cases: all, then each class
};

/// `limit`: size below which nothing can be seen; `visible`: from which on effects are to be named.
Score count(const std::vector<Judged>& cases, double limit, double visible);

}  // namespace battery
