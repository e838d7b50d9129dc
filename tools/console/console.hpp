#pragma once

#include <string>

#include "execute/execute.hpp"
#include "graph/problem.hpp"

namespace bodeflow::tools {

/// What the command's process ends with.
enum ExitCode {
  kDone = 0,
  kRunFailed = 1,
  kUsage = 2,
  kRejected = 3,  ///< graph or data
  kPlugin = 4,
  kDevice = 5,  ///< or network
  kGateMissed = 6,
  kLimitViolated = 7,
  kInterrupted = 130
};

/// Messages for people, on standard error; colours on a terminal unless NO_COLOR is set.
void say(const std::string& text);
void say_warning(const std::string& text);
void say_error(const std::string& text);
/// Every problem a line, and how many there are.
void say_problems(const Problems& problems);

/// The text as bold or dim on standard output where that is a terminal.
std::string bold(const std::string& text);
std::string dim(const std::string& text);

/// One line on a terminal that shows how far a run is and how long it will take; nothing in a pipe.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const std::string& phase, const execute::Progress& progress);
  void clear();

 private:
  struct State;
  State* state_;
};

/// "1.23 s", "4 min 05 s", "2 h 03 min".
std::string duration_text(double seconds);
/// A number with an SI prefix and four digits: "12.5 k", "3.2 u".
std::string si(double value, const std::string& unit);

}  // namespace bodeflow::tools
