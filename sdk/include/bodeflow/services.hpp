#pragma once

#include <bodeflow/abi.h>

#include <bodeflow/error.hpp>
#include <optional>
#include <string>

namespace bodeflow {
inline namespace v0 {

/// What the host does for a block. Services that a host does not have are left out silently, except files.
class Services {
 public:
  Services() = default;
  explicit Services(const bf_host& host)
      : host_(&host),
        log_(static_cast<const bf_log*>(host.extension(&host, BF_EXTENSION_LOG))),
        files_(static_cast<const bf_files*>(host.extension(&host, BF_EXTENSION_FILES))) {}

  void log(std::int32_t level, const std::string& text) const {
    if (log_ != nullptr) log_->write(host_, level, text.c_str());
  }
  void note_input(const std::string& path) const {
    if (files_ != nullptr && files_->note_input(host_, path.c_str()) != BF_OK) throw HostRefused();
  }
  std::optional<std::string> output_path(const std::string& name) const {
    if (files_ == nullptr) return std::nullopt;
    const char* path = files_->output_path(host_, name.c_str());
    if (path == nullptr) throw HostRefused();
    if (*path == '\0') return std::nullopt;
    return std::string(path);
  }

  /// Of a block that a host made.
  const bf_host& host() const {
    if (host_ == nullptr) fail("the block has no host");
    return *host_;
  }

  /// Thrown when the host has stated the reason itself.
  struct HostRefused {};

 private:
  const bf_host* host_ = nullptr;
  const bf_log* log_ = nullptr;
  const bf_files* files_ = nullptr;
};

}  // namespace v0
}  // namespace bodeflow
