#include "test_host.hpp"

#include <algorithm>
#include <bodeflow/testing/hook.hpp>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <utility>

namespace bodeflow::testing {
namespace {

constexpr std::uint8_t kGuardByte = 0xA7;

/// A record with its owner before it, at a distance that keeps the bytes aligned.
struct OwnedRecord {
  bf_record record;
  int* alive;
  int count;
};

/// While it lives, the hook does not count.
class HookRest {
 public:
  HookRest() {
    if (bodeflow_hook_pause != nullptr) was_armed_ = bodeflow_hook_pause(0);
  }
  ~HookRest() {
    if (bodeflow_hook_pause != nullptr) bodeflow_hook_pause(was_armed_);
  }
  HookRest(const HookRest&) = delete;
  HookRest& operator=(const HookRest&) = delete;

 private:
  int was_armed_ = 0;
};

/// The effects and base models that hosts offer, ordered by id.
struct Offered {
  struct Kind {
    std::vector<const bf_factory*> factories;
    std::vector<const void*> descriptors;
  };
  Kind effects, base_models, none;

  const Kind& of(const char* kind) const {
    return std::strcmp(kind, "effect") == 0 ? effects : std::strcmp(kind, "base_model") == 0 ? base_models : none;
  }
};

Offered& offered() {
  static Offered parts;
  return parts;
}

OwnedRecord* owner(const bf_record* record) { return reinterpret_cast<OwnedRecord*>(const_cast<bf_record*>(record)); }

}  // namespace

/// What the plugin calls. Work of the host is no work of the plugin's `process`: the hook rests meanwhile.
struct HostCalls {
  static TestHost& of(const bf_host* host) { return *static_cast<TestHost*>(host->context); }

  static void error(const bf_host* host, const char* text) { of(host).error_ = text == nullptr ? "" : text; }

  static std::int32_t note_input(const bf_host*, const char*) { return BF_OK; }

  static const char* output_path(const bf_host* host, const char* name) {
    TestHost& self = of(host);
    const std::filesystem::path path(name == nullptr ? "" : name);
    if (path.empty() || path.is_absolute() || path.lexically_normal().string().rfind("..", 0) == 0) {
      self.error_ = "the path leaves the run directory";
      return nullptr;
    }
    if (self.folder_.empty()) {
      std::string folder = (std::filesystem::temp_directory_path() / "bodeflow-test-XXXXXX").string();
      if (mkdtemp(folder.data()) == nullptr) {
        self.error_ = "no temporary folder can be made";
        return nullptr;
      }
      self.folder_ = folder;
    }
    const auto whole = std::filesystem::path(self.folder_) / path;
    std::error_code ignored;
    std::filesystem::create_directories(whole.parent_path(), ignored);
    return self.paths_.emplace_back(whole.string()).c_str();
  }

  static void log(const bf_host* host, std::int32_t level, const char* text) {
    if (level >= BF_LOG_WARNING) of(host).log_ = text;
  }

  static const void* const* list_parts(const bf_host*, const char* kind, std::uint32_t* count) {
    const Offered::Kind& found = offered().of(kind);
    *count = static_cast<std::uint32_t>(found.descriptors.size());
    return found.descriptors.data();
  }
  static std::int32_t create_part(const bf_host* host, const char* kind, const char* id, void* made) {
    for (const bf_factory* factory : offered().of(kind).factories) {
      if (std::strcmp(factory->id, id) == 0) return factory->create(factory, host, made);
    }
    of(host).error_ = std::string("the plugin gives no ") + kind + " '" + id + "'";
    return BF_FAILED;
  }

  static const void* extension(const bf_host*, const char* id) {
    static const bf_log kLog{sizeof(bf_log), &log};
    static const bf_files kFiles{sizeof(bf_files), &note_input, &output_path};
    static const bf_parts kParts{sizeof(bf_parts), &list_parts, &create_part};
    if (std::strcmp(id, BF_EXTENSION_LOG) == 0) return &kLog;
    if (std::strcmp(id, BF_EXTENSION_FILES) == 0) return &kFiles;
    if (std::strcmp(id, BF_EXTENSION_PARTS) == 0) return &kParts;
    return nullptr;
  }

  static bf_record* record_create(const bf_host* host, std::uint64_t size) {
    const HookRest rest;
    const std::size_t rounded = (static_cast<std::size_t>(size) + 63) / 64 * 64;
    if (rounded < size) return nullptr;
    auto* bytes = static_cast<std::uint8_t*>(std::aligned_alloc(64, rounded == 0 ? 64 : rounded));
    if (bytes == nullptr) return nullptr;
    std::memset(bytes, 0, rounded);
    auto* made = new (std::nothrow) OwnedRecord{{bytes, size}, &of(host).records_alive_, 1};
    if (made == nullptr) return std::free(bytes), nullptr;
    ++*made->alive;
    return &made->record;
  }
  static void record_retain(const bf_host*, const bf_record* record) { ++owner(record)->count; }
  static void record_release(const bf_host*, const bf_record* record) { TestHost::release(record); }
};

TestHost::TestHost() {
  c_.struct_size = sizeof c_;
  c_.abi_major = BF_ABI_MAJOR;
  c_.abi_minor = BF_ABI_MINOR;
  c_.context = this;
  c_.error = &HostCalls::error;
  c_.extension = &HostCalls::extension;
  c_.record_create = &HostCalls::record_create;
  c_.record_retain = &HostCalls::record_retain;
  c_.record_release = &HostCalls::record_release;
}

void TestHost::offer_parts(const LoadedPlugin& plugin) {
  Offered parts;
  for (std::uint32_t i = 0; i < plugin.count; ++i) {
    const bf_factory* f = plugin.factories[i];
    if (std::strcmp(f->kind, "effect") == 0) parts.effects.factories.push_back(f);
    if (std::strcmp(f->kind, "base_model") == 0) parts.base_models.factories.push_back(f);
  }
  for (Offered::Kind* kind : {&parts.effects, &parts.base_models}) {
    std::sort(kind->factories.begin(), kind->factories.end(),
              [](const bf_factory* a, const bf_factory* b) { return std::strcmp(a->id, b->id) < 0; });
    for (const bf_factory* f : kind->factories) kind->descriptors.push_back(f->descriptor);
  }
  offered() = std::move(parts);
}

TestHost::~TestHost() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::string TestHost::take_error() {
  std::string text = std::exchange(error_, {});
  return text.empty() ? "without a reason" : text;
}

void TestHost::release(const bf_record* record) {
  OwnedRecord* made = owner(record);
  if (--made->count > 0) return;
  --*made->alive;
  std::free(made->record.bytes);
  delete made;
}

GuardedBuffer::GuardedBuffer(std::size_t count, std::size_t size, std::uint8_t fill)
    : used_(count * size),
      total_((used_ + 2 * kGuard + 63) / 64 * 64),
      bytes_(static_cast<std::uint8_t*>(std::aligned_alloc(64, total_))) {
  if (!bytes_) throw std::bad_alloc();
  std::memset(bytes_.get(), kGuardByte, total_);
  std::memset(bytes_.get() + kGuard, fill, used_);
}

bool GuardedBuffer::intact() const {
  for (std::size_t i = 0; i < total_; ++i) {
    if ((i < kGuard || i >= kGuard + used_) && bytes_.get()[i] != kGuardByte) return false;
  }
  return true;
}

void GuardedBuffer::Free::operator()(std::uint8_t* p) const { std::free(p); }

}  // namespace bodeflow::testing
