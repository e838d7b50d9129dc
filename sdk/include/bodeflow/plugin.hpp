#pragma once

#include <bodeflow/abi.h>

#include <bodeflow/border.hpp>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// The factory of class T. This is that of blocks; <bodeflow/parts.hpp> has those of effects and base models.
template <class T, class = void>
struct FactoryOf {
  static_assert(std::is_base_of_v<Block, T>, "no block; effects and base models need <bodeflow/parts.hpp>");
  static bf_factory make() {
    const bf_block_descriptor& d = block_type<T>().c();
    return {sizeof(bf_factory), 0, "block", d.id, &d, Border<T>::create};
  }
};

/// The factories of classes of blocks, effects and base models, described and checked.
class FactoryTable {
 public:
  /// Throws Failure with all that is wrong with the descriptions.
  template <class... Classes>
  static FactoryTable of() {
    FactoryTable table;
    (table.add<Classes>(), ...);
    if (!table.problems_.empty()) fail(table.problems_);
    return table;
  }

  const bf_factory* const* places() const { return places_.data(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(places_.size()); }

 private:
  template <class T>
  void add() {
    // Where the factory lives as long as the plugin, whatever happens to the table.
    static bf_factory factory{};
    try {
      factory = FactoryOf<T>::make();
      for (const bf_factory* other : places_) {
        if (std::string_view(other->id) == factory.id) fail(std::string("id '") + factory.id + "' stands twice");
      }
      places_.push_back(&factory);
    } catch (const Failure& failure) {
      if (!problems_.empty()) problems_ += '\n';
      problems_ += failure.what();
    }
  }

  std::vector<const bf_factory*> places_;
  std::string problems_;
};

/// The factories of a plugin with these classes, for bf_plugin.factories.
template <class... Classes>
const bf_factory* const* plugin_factories(const bf_host* host, std::uint32_t* count) noexcept {
  const bf_factory* const* places = nullptr;
  *count = 0;
  guarded(host, [&] {
    static const FactoryTable table = FactoryTable::of<Classes...>();
    places = table.places();
    *count = table.count();
  });
  return places;
}

/// True for what the ELF note can hold: printable ASCII without quote and backslash, shorter than `room`.
template <std::size_t N>
constexpr bool fits_note(const char (&text)[N], std::size_t room) {
  if (N < 2 || N > room) return false;
  for (std::size_t i = 0; i + 1 < N; ++i) {
    if (text[i] < ' ' || text[i] > '~' || text[i] == '"' || text[i] == '\\' || text[i] == '%') return false;
  }
  return true;
}

}  // namespace v0
}  // namespace bodeflow

#define BODEFLOW_TEXT_(x) #x
#define BODEFLOW_TEXT(x) BODEFLOW_TEXT_(x)

#if defined(__clang__)
#define BODEFLOW_COMPILER "clang " BODEFLOW_TEXT(__clang_major__) "." BODEFLOW_TEXT(__clang_minor__)
#elif defined(__GNUC__)
#define BODEFLOW_COMPILER "gcc " BODEFLOW_TEXT(__GNUC__) "." BODEFLOW_TEXT(__GNUC_MINOR__)
#else
#define BODEFLOW_COMPILER "unknown compiler"
#endif
#if defined(_LIBCPP_VERSION)
#define BODEFLOW_LIBRARY "libc++ " BODEFLOW_TEXT(_LIBCPP_VERSION)
#elif defined(_GLIBCXX_RELEASE)
#define BODEFLOW_LIBRARY "libstdc++ " BODEFLOW_TEXT(_GLIBCXX_RELEASE)
#else
#define BODEFLOW_LIBRARY "unknown library"
#endif
#define BODEFLOW_BUILD BODEFLOW_COMPILER ", " BODEFLOW_LIBRARY

// One ELF note: name "bodeflow", type BF_NOTE_TYPE, descriptor bf_elf_note (144 bytes). Written by the assembler, because a
// variable in a section of that name would not be of the type SHT_NOTE that linkers keep under --gc-sections and strip keeps.
#define BODEFLOW_NOTE_(name, version) \
  __asm__(".pushsection .note.bodeflow, \"a\", %note\n"   \
          ".balign 4\n"                                   \
          ".long 9, 144, 1\n"                             \
          ".asciz \"bodeflow\"\n"                         \
          ".balign 4\n"                                   \
          ".quad 0x574F4C4645444F42\n"                    \
          ".long " BODEFLOW_TEXT(BF_ABI_MAJOR) ", " BODEFLOW_TEXT(BF_ABI_MINOR) "\n" \
          "770: .ascii \"" name "\"\n"                    \
          ".skip 48 - (. - 770b)\n"                       \
          "771: .ascii \"" version "\"\n"                 \
          ".skip 16 - (. - 771b)\n"                       \
          "772: .ascii \"" BODEFLOW_BUILD "\"\n"          \
          ".skip 64 - (. - 772b)\n"                       \
          ".popsection\n")

/// Makes the shared library that is being compiled a plugin with these classes of blocks, effects and base models: exactly once
/// in it, at namespace scope. Name and version are literals: BODEFLOW_PLUGIN("example", "1.0.0", Gain, Delay)
#define BODEFLOW_PLUGIN(name, version, ...)                                                                                    \
  static_assert(::bodeflow::fits_note(name, 48), "a plugin's name has 1 to 47 plain characters");                              \
  static_assert(::bodeflow::fits_note(version, 16), "a plugin's version has 1 to 15 plain characters");                        \
  static_assert(BF_PLUGIN_MAGIC == 0x574F4C4645444F42 && sizeof(bf_elf_note) == 144 && BF_NOTE_TYPE == 1, "the note's bytes"); \
  BODEFLOW_NOTE_(name, version);                                                                                               \
  extern "C" {                                                                                                                 \
  extern __attribute__((visibility("default"))) const bf_plugin bodeflow_plugin_v1;                                            \
  const bf_plugin bodeflow_plugin_v1 = {BF_PLUGIN_MAGIC,                                                                       \
                                        BF_ABI_MAJOR,                                                                          \
                                        BF_ABI_MINOR,                                                                          \
                                        sizeof(bf_plugin),                                                                     \
                                        0,                                                                                     \
                                        name,                                                                                  \
                                        version,                                                                               \
                                        BODEFLOW_BUILD,                                                                        \
                                        ::bodeflow::plugin_factories<__VA_ARGS__>};                                            \
  }
