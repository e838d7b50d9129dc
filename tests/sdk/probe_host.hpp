#pragma once

#include <bodeflow/abi.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

/// A host for tests: keeps error and log texts, and the records that it was asked for.
class ProbeHost {
 public:
  ProbeHost() {
    host.struct_size = sizeof host;
    host.abi_minor = BF_ABI_MINOR;
    host.context = this;
    host.error = [](const bf_host* h, const char* text) { of(h).error = text; };
    host.extension = [](const bf_host* h, const char* id) -> const void* {
      static const bf_log kLog{sizeof(bf_log), [](const bf_host* on, std::int32_t level, const char* text) {
                                 of(on).log += std::to_string(level) + " " + text + "\n";
                               }};
      static const bf_files kFiles{sizeof(bf_files),
                                   [](const bf_host* on, const char* path) -> std::int32_t {
                                     if (*path != '\0') return BF_OK;
                                     on->error(on, "an empty path");
                                     return BF_FAILED;
                                   },
                                   [](const bf_host* on, const char* name) -> const char* {
                                     if (std::strcmp(name, "check") == 0) return "";
                                     if (*name != '/') return "/run/file";
                                     on->error(on, "an absolute path");
                                     return nullptr;
                                   }};
      if (of(h).bare) return nullptr;
      return std::strcmp(id, BF_EXTENSION_LOG) == 0     ? static_cast<const void*>(&kLog)
             : std::strcmp(id, BF_EXTENSION_FILES) == 0 ? static_cast<const void*>(&kFiles)
                                                        : nullptr;
    };
    host.record_create = [](const bf_host* h, std::uint64_t size) -> bf_record* {
      if (of(h).out_of_memory) return nullptr;
      auto* record = new bf_record{static_cast<std::uint8_t*>(std::aligned_alloc(64, size)), size};
      std::memset(record->bytes, 0, size);
      return record;
    };
    host.record_retain = [](const bf_host*, const bf_record*) {};
    host.record_release = [](const bf_host*, const bf_record* record) { drop(record); };
  }

  static void drop(const bf_record* record) {
    std::free(record->bytes);
    delete record;
  }
  static ProbeHost& of(const bf_host* h) { return *static_cast<ProbeHost*>(h->context); }

  bf_host host{};
  std::string error, log;
  bool out_of_memory = false;
  bool bare = false;  ///< offers no services
};
