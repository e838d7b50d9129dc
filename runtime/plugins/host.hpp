#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "plugins/instance.hpp"
#include "plugins/part_shelf.hpp"

namespace bodeflow {

/// The bf_host of one block (or of a plugin, without name and services): error text, records, log, files and parts.
/// Its address stays: blocks keep it.
class Host {
 public:
  /// `services` may be null: no log, no files. `parts` may be null: no effects and base models.
  Host(std::string block, std::shared_ptr<const HostServices> services, std::shared_ptr<PartShelf> parts = nullptr);
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  const bf_host& c() const { return c_; }
  /// take_error of the object behind a bf_host; without a reason where somebody else made it.
  static std::string error_of(const bf_host& host);

  /// The text given since the last call, or "failed without a reason". Any thread.
  std::string take_error();
  /// Forgets a text that belongs to no failure.
  void clear_error();

 private:
  friend struct HostFunctions;
  static Host& of(const bf_host& host) { return *static_cast<Host*>(host.context); }
  void set_error(const char* text);

  bf_host c_{};
  std::string block_;
  std::shared_ptr<const HostServices> services_;
  std::shared_ptr<PartShelf> parts_;
  std::mutex mutex_;
  std::string error_;
  std::deque<std::string> paths_;  // given out by output_path: they live as long as the block
};

}  // namespace bodeflow
