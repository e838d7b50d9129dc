#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow {

/// How a child process ended, and what it wrote.
struct ChildResult {
  std::string output;    ///< standard output, at most 64 MiB
  std::string messages;  ///< the last 8 KiB of standard error
  int exit_code = -1;    ///< -1: ended by `signal`, or killed after the time limit
  int signal = 0;
  bool timed_out = false;
};

/// Runs a program (arguments[0] is its path) with empty standard input, until it ends or `timeout_s` is over; then it is
/// killed. Any thread. Error: why it could not be started.
tl::expected<ChildResult, std::string> run_child(const std::vector<std::string>& arguments, double timeout_s);

}  // namespace bodeflow
