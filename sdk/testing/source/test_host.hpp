#pragma once

#include <bodeflow/abi.h>

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "plugin_file.hpp"

namespace bodeflow::testing {

/// A host for one block under test: keeps its error text, counts its records, gives it files in a folder of its own.
class TestHost {
 public:
  TestHost();
  ~TestHost();
  TestHost(const TestHost&) = delete;
  TestHost& operator=(const TestHost&) = delete;

  const bf_host* c() const { return &c_; }
  /// The text of the last failure; "without a reason" if the plugin gave none.
  std::string take_error();
  /// Records that are made and neither sent nor released.
  int records_alive() const { return records_alive_; }
  /// The last warning or error that was logged.
  const std::string& log() const { return log_; }

  /// From here on hosts offer the effects and base models of this plugin, as the real host does with those of all.
  static void offer_parts(const LoadedPlugin& plugin);

  static void release(const bf_record* record);

 private:
  friend struct HostCalls;
  bf_host c_{};
  std::string error_;
  std::string log_;
  std::string folder_;
  std::list<std::string> paths_;
  int records_alive_ = 0;
};

/// A sample buffer whose ends are guarded: `intact` tells whether something wrote outside.
class GuardedBuffer {
 public:
  /// `count` elements of `size` bytes, filled with `fill` bytes, at a 64-byte boundary.
  GuardedBuffer(std::size_t count, std::size_t size, std::uint8_t fill);
  void* data() { return bytes_.get() + kGuard; }
  const void* data() const { return bytes_.get() + kGuard; }
  bool intact() const;

 private:
  static constexpr std::size_t kGuard = 256;
  struct Free {
    void operator()(std::uint8_t* p) const;
  };
  std::size_t used_;
  std::size_t total_;
  std::unique_ptr<std::uint8_t, Free> bytes_;
};

}  // namespace bodeflow::testing
