#pragma once

#include <string>
#include <vector>

namespace bodeflow::testing {

enum class Status { pass, fail, skip };

/// One thing that was checked.
struct Check {
  std::string block;    ///< its id; "" for the plugin as a whole
  std::string setting;  ///< "gain = 2, mode = fast"; "" for the defaults
  std::string name;     ///< a sentence of behaviour
  Status status = Status::pass;
  std::string reason;  ///< of a failure or a skip
};

/// What the suite found out about a plugin file.
struct Report {
  std::string file;
  std::vector<Check> checks;

  int count(Status status) const {
    int n = 0;
    for (const Check& c : checks) n += c.status == status ? 1 : 0;
    return n;
  }
  /// True if something was checked and nothing failed.
  bool passed() const { return count(Status::pass) > 0 && count(Status::fail) == 0; }
};

/// The report for people: a line a check that failed or was skipped (with `all`, of every check), and a line that counts.
std::string to_text(const Report& report, bool all = false);

}  // namespace bodeflow::testing
