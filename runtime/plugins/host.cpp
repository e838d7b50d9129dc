#include "plugins/host.hpp"

#include <cstring>
#include <exception>
#include <string_view>
#include <utility>

#include "plugins/record_memory.hpp"

namespace bodeflow {
namespace {

constexpr std::size_t kMostText = 65536;  // of one message of a plugin
constexpr const char* kNoReason = "failed without a reason";

}  // namespace

/// What a plugin calls. Nothing of the host's may be thrown through the plugin.
struct HostFunctions {
  static void error(const bf_host* host, const char* text) noexcept {
    try {
      Host::of(*host).set_error(text);
    } catch (...) {  // out of memory: the failure stays without a reason
    }
  }

  static void log(const bf_host* host, std::int32_t level, const char* text) noexcept {
    try {
      const Host& self = Host::of(*host);
      if (self.services_ == nullptr || !self.services_->log || text == nullptr) return;
      self.services_->log(self.block_, level, std::string(text, strnlen(text, kMostText)));
    } catch (...) {  // a log line is lost
    }
  }

  static std::int32_t note_input(const bf_host* host, const char* path) noexcept {
    return guarded(host, [&](Host& self) {
      if (path == nullptr) return self.set_error("note_input: the path is a null pointer"), BF_FAILED;
      if (self.services_ != nullptr && self.services_->note_input) self.services_->note_input(self.block_, path);
      return BF_OK;
    });
  }

  static const char* output_path(const bf_host* host, const char* name) noexcept {
    const char* path = nullptr;
    guarded(host, [&](Host& self) {
      if (name == nullptr) return self.set_error("output_path: the name is a null pointer"), BF_FAILED;
      if (self.services_ == nullptr || !self.services_->output_path) return path = "", BF_OK;  // a check: no path, no error
      auto found = self.services_->output_path(self.block_, name);
      if (!found) return self.set_error(found.error().c_str()), BF_FAILED;
      const std::lock_guard lock(self.mutex_);
      path = self.paths_.emplace_back(std::move(*found)).c_str();
      return BF_OK;
    });
    return path;
  }

  static const void* const* list_parts(const bf_host* host, const char* kind, std::uint32_t* count) noexcept {
    const void* const* list = nullptr;
    *count = 0;
    guarded(host, [&](Host& self) {
      const std::vector<const void*>& found = self.parts_->list(kind == nullptr ? "" : kind);
      list = found.data();
      *count = static_cast<std::uint32_t>(found.size());
      return BF_OK;
    });
    return list;
  }

  static std::int32_t create_part(const bf_host* host, const char* kind, const char* id, void* made) noexcept {
    return guarded(host, [&](Host& self) {
      if (kind == nullptr || id == nullptr) return self.set_error("a part's kind or id is a null pointer"), BF_FAILED;
      if (auto done = self.parts_->make(kind, id, *host, made); !done) return self.set_error(done.error().c_str()), BF_FAILED;
      return BF_OK;
    });
  }

  static const void* extension(const bf_host* host, const char* id) noexcept {
    static const bf_log kLog{sizeof(bf_log), &log};
    static const bf_files kFiles{sizeof(bf_files), &note_input, &output_path};
    static const bf_parts kParts{sizeof(bf_parts), &list_parts, &create_part};
    if (id == nullptr) return nullptr;
    if (std::string_view(id) == BF_EXTENSION_LOG) return &kLog;
    if (std::string_view(id) == BF_EXTENSION_FILES) return &kFiles;
    const Host& self = Host::of(*host);
    if (std::string_view(id) == BF_EXTENSION_PARTS && self.parts_ != nullptr) return &kParts;
    try {
      return self.services_ != nullptr && self.services_->extension ? self.services_->extension(id) : nullptr;
    } catch (...) {
      return nullptr;
    }
  }

 private:
  template <class Call>
  static std::int32_t guarded(const bf_host* host, Call&& call) noexcept {
    try {
      return call(Host::of(*host));
    } catch (const std::exception& exception) {
      error(host, exception.what());
    } catch (...) {
      error(host, "the host failed");
    }
    return BF_FAILED;
  }
};

Host::Host(std::string block, std::shared_ptr<const HostServices> services, std::shared_ptr<PartShelf> parts)
    : block_(std::move(block)), services_(std::move(services)), parts_(std::move(parts)) {
  c_.struct_size = sizeof c_;
  c_.abi_major = BF_ABI_MAJOR;
  c_.abi_minor = BF_ABI_MINOR;
  c_.context = this;
  c_.error = &HostFunctions::error;
  c_.extension = &HostFunctions::extension;
  c_.record_create = [](const bf_host*, std::uint64_t size) { return record_create(size); };
  c_.record_retain = [](const bf_host*, const bf_record* record) { record_retain(record); };
  c_.record_release = [](const bf_host*, const bf_record* record) { record_release(record); };
}

void Host::set_error(const char* text) {
  std::string copy = text == nullptr ? std::string() : std::string(text, strnlen(text, kMostText));
  const std::lock_guard lock(mutex_);
  error_ = std::move(copy);
}

std::string Host::take_error() {
  const std::lock_guard lock(mutex_);
  return error_.empty() ? std::string(kNoReason) : std::exchange(error_, {});
}

std::string Host::error_of(const bf_host& host) {
  return host.error == &HostFunctions::error ? of(host).take_error() : std::string(kNoReason);
}

void Host::clear_error() {
  const std::lock_guard lock(mutex_);
  error_.clear();
}

}  // namespace bodeflow
