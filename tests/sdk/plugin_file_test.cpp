#include <bodeflow/abi.h>
#include <dlfcn.h>
#include <elf.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "catch.hpp"

namespace {

std::vector<char> bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

template <class T>
T at(const std::vector<char>& bytes, std::size_t offset) {
  T value;
  REQUIRE(offset + sizeof value <= bytes.size());
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// The descriptors of our notes in the loadable note segments of a file, found without the SDK's own reader.
std::vector<bf_elf_note> notes(const std::string& file) {
  std::vector<bf_elf_note> found;
  const auto bytes = bytes_of(file);
  const auto header = at<Elf64_Ehdr>(bytes, 0);
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    const auto segment = at<Elf64_Phdr>(bytes, header.e_phoff + i * sizeof(Elf64_Phdr));
    if (segment.p_type != PT_NOTE) continue;
    for (std::size_t p = segment.p_offset; p < segment.p_offset + segment.p_filesz;) {
      const auto note = at<Elf64_Nhdr>(bytes, p);
      const std::size_t name = p + sizeof note, descriptor = name + (note.n_namesz + 3u) / 4 * 4;
      if (std::string(bytes.data() + name) == BF_NOTE_NAME && note.n_type == BF_NOTE_TYPE) {
        CHECK(note.n_descsz == sizeof(bf_elf_note));
        found.push_back(at<bf_elf_note>(bytes, descriptor));
      }
      p = descriptor + (note.n_descsz + 3u) / 4 * 4;
    }
  }
  return found;
}

}  // namespace

TEST_CASE("a plugin, linked with --gc-sections and stripped, tells in its ELF note what it is") {
  for (const char* file : {BODEFLOW_GOOD_PLUGIN, BODEFLOW_STRIPPED_PLUGIN}) {
    INFO(file);
    const auto found = notes(file);
    REQUIRE(found.size() == 1);
    CHECK(found[0].magic == BF_PLUGIN_MAGIC);
    CHECK(found[0].abi_major == BF_ABI_MAJOR);
    CHECK(found[0].abi_minor == BF_ABI_MINOR);
    CHECK(std::string(found[0].name) == "good");
    CHECK(std::string(found[0].version) == "1.2.3");
    CHECK(std::string(found[0].build).find("lib") != std::string::npos);
  }
}

TEST_CASE("a plugin's entry says the same as its note") {
  void* library = dlopen(BODEFLOW_STRIPPED_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  REQUIRE(library != nullptr);
  const auto* plugin = static_cast<const bf_plugin*>(dlsym(library, BF_PLUGIN_SYMBOL));
  REQUIRE(plugin != nullptr);
  CHECK(plugin->magic == BF_PLUGIN_MAGIC);
  CHECK(plugin->struct_size == sizeof(bf_plugin));
  CHECK(std::string(plugin->name) == "good");
  CHECK(std::string(plugin->build) == notes(BODEFLOW_STRIPPED_PLUGIN).at(0).build);
  bf_host host{};
  std::uint32_t count = 0;
  const bf_factory* const* factories = plugin->factories(&host, &count);
  REQUIRE(factories != nullptr);
  REQUIRE(count == 12);
  CHECK(std::string(factories[0]->kind) == "block");
  CHECK(std::string(factories[0]->id) == "good.gain");
  CHECK(std::string(factories[3]->kind) == "effect");
  CHECK(std::string(factories[11]->kind) == "base_model");
  CHECK(factories == plugin->factories(&host, &count));
}
