#pragma once

#include <bodeflow/testing/report.hpp>
#include <functional>
#include <string>

namespace bodeflow::testing {

/// How one check ended.
struct Verdict {
  Status status = Status::pass;
  std::string reason;
  bool timed_out = false;
};

/// Thrown by a check that can not be made, with the reason; without one by a check that does not apply and is not reported.
struct Skip {
  std::string reason;
};

/// Says what a check is about to do, so that a crash can be told where it was.
using Step = std::function<void(const std::string&)>;

/// The verdict of `work`: pass if it returns, fail if it throws, skip if it throws Skip. With `isolate` it runs in a child
/// process with 2 GB more memory than the caller has: a crash, an exit, or more than `timeout_s` seconds are failures.
Verdict judge(const std::function<void(const Step&)>& work, bool isolate, unsigned timeout_s);

}  // namespace bodeflow::testing
