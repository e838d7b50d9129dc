#pragma once

#include "plan/plan.hpp"
#include "record/run_directory.hpp"

namespace bodeflow::phases {

/// Tells of the limits of one run of a phase: each first violation while it runs, in the events and, unless it ends the run, as a
/// warning; how many there were, at the end. Of a sweep, whose runs are processes of their own, when all have ended.
class LimitTeller {
 public:
  /// All of them outlive it.
  LimitTeller(const graph::Phase& phase, int repeat, const plan::Plan& plan, record::RunDirectory& directory,
              const HostServices& services)
      : phase_(phase), repeat_(repeat), plan_(plan), directory_(directory), services_(services) {}

  void violated(int limit, const execute::Violation& violation) const;
  void ended(const execute::Outcome& outcome) const;
  /// `runs`: the limits of each run as its manifest has them.
  void swept(const std::vector<nlohmann::json>& runs) const;

 private:
  const graph::Phase& phase_;
  int repeat_;
  const plan::Plan& plan_;
  record::RunDirectory& directory_;
  const HostServices& services_;
};

}  // namespace bodeflow::phases
