#pragma once

#include "rig.hpp"

namespace bodeflow::testing {

/// The memory of one stream port for a whole run.
struct Lane {
  std::uint32_t element = BF_F64;
  std::uint32_t samples = 1;  ///< per firing
  std::vector<std::shared_ptr<GuardedBuffer>> buffers;
  std::vector<void*> places;
};

/// One run of an active block over all samples of its feed.
class Run {
 public:
  Run(const Rig& rig, const Calls& calls);
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Trace whole();

 private:
  static void emit(bf_process* process, std::uint32_t port, bf_record* record, std::uint64_t offset);
  void make_inputs();
  void make_outputs();
  void share_memory();
  void make_messages();
  /// Points the call at `count` firings from `position` on.
  void place(std::uint64_t position, std::uint64_t count);
  /// How many firings the call at `position` has; makes the change that is due there.
  std::uint64_t next_count(std::uint64_t position, std::uint64_t total);
  bool process();
  /// False if that call failed; then the trace has the block's words.
  bool took(std::int32_t result, const char* function);
  void call_all();
  void collect();

  const Rig& rig_;
  const Calls& calls_;
  std::vector<Lane> inputs_, outputs_;
  std::vector<bf_stream> in_, out_;
  std::vector<bf_record*> sent_;
  std::vector<bf_message> messages_;
  bf_process process_{};
  Trace trace_;
  std::string error_;
};

}  // namespace bodeflow::testing
