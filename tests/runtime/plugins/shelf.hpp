#pragma once

#include <bodeflow/parts.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "plugins/registry.hpp"

namespace bodeflow::test {

/// The parts of some plugins, as a block has them; the registry itself is gone.
class Shelf {
 public:
  explicit Shelf(const std::vector<std::filesystem::path>& files) {
    Registry::Options options;
    options.path = files;
    options.probe_command = BODEFLOW_PROBE_HELPER;
    const Registry registry(options);
    for (const auto& plugin : registry.plugins()) refused += plugin.refused;
    shelf_ = registry.parts();
    host_.struct_size = sizeof host_;
    host_.context = this;
    host_.error = [](const bf_host* h, const char* text) { of(h).error = text; };
    host_.extension = [](const bf_host*, const char* id) -> const void* {
      static const bf_log kLog{sizeof(bf_log), [](const bf_host* h, std::int32_t level, const char* text) {
                                 of(h).log.push_back(std::to_string(level) + " " + text);
                               }};
      static const bf_parts kParts{sizeof(bf_parts), list, create};
      const std::string name(id);
      return name == BF_EXTENSION_LOG ? static_cast<const void*>(&kLog) : name == BF_EXTENSION_PARTS ? &kParts : nullptr;
    };
  }
  Shelf(const Shelf&) = delete;
  Shelf& operator=(const Shelf&) = delete;

  Parts parts() const { return Parts(host_); }

  std::string refused, error;
  std::vector<std::string> log;

 private:
  static Shelf& of(const bf_host* host) { return *static_cast<Shelf*>(host->context); }
  static const void* const* list(const bf_host* host, const char* kind, std::uint32_t* count) {
    const auto& found = of(host).shelf_->list(kind);
    *count = static_cast<std::uint32_t>(found.size());
    return found.data();
  }
  static std::int32_t create(const bf_host* host, const char* kind, const char* id, void* made) {
    const auto done = of(host).shelf_->make(kind, id, *host, made);
    if (!done) of(host).error = done.error();
    return done ? BF_OK : BF_FAILED;
  }

  std::shared_ptr<PartShelf> shelf_;
  bf_host host_{};
};

/// The text of the Failure that `work` ends with, or "no failure".
template <class Work>
std::string failure_of(Work&& work) {
  try {
    work();
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "no failure";
}

}  // namespace bodeflow::test
