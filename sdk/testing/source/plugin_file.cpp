#include "plugin_file.hpp"

#include <dlfcn.h>
#include <elf.h>

#include <bodeflow/error.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "test_host.hpp"

namespace bodeflow::testing {
namespace {

/// A host for the one call of `factories`, which needs no block.
TestHost& loader_host() {
  static TestHost host;
  return host;
}

class Bytes {
 public:
  explicit Bytes(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(file + ": can't be read");
    bytes_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }

  template <class T>
  std::optional<T> at(std::uint64_t offset) const {
    if (offset > bytes_.size() || bytes_.size() - offset < sizeof(T)) return std::nullopt;
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  bool has(std::uint64_t offset, const char* text, std::size_t size) const {
    return offset <= bytes_.size() && bytes_.size() - offset >= size && std::memcmp(bytes_.data() + offset, text, size) == 0;
  }

 private:
  std::vector<char> bytes_;
};

/// The note of ours in a section of notes.
std::optional<bf_elf_note> find_note(const Bytes& bytes, std::uint64_t begin, std::uint64_t size) {
  std::uint64_t at = begin;
  const std::uint64_t end = size > UINT64_MAX - begin ? UINT64_MAX : begin + size;
  while (at < end) {
    const auto header = bytes.at<Elf64_Nhdr>(at);
    if (!header) return std::nullopt;
    const std::uint64_t name = at + sizeof *header;
    const std::uint64_t descriptor = name + (std::uint64_t{header->n_namesz} + 3) / 4 * 4;
    if (header->n_type == BF_NOTE_TYPE && header->n_namesz == sizeof BF_NOTE_NAME && header->n_descsz >= sizeof(bf_elf_note) &&
        bytes.has(name, BF_NOTE_NAME, sizeof BF_NOTE_NAME)) {
      return bytes.at<bf_elf_note>(descriptor);
    }
    at = descriptor + (std::uint64_t{header->n_descsz} + 3) / 4 * 4;
  }
  return std::nullopt;
}

}  // namespace

LoadedPlugin load_plugin(const std::string& file) {
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) fail(dlerror());
  const auto* plugin = static_cast<const bf_plugin*>(dlsym(library, BF_PLUGIN_SYMBOL));
  if (plugin == nullptr) fail("exports no " BF_PLUGIN_SYMBOL);
  if (plugin->magic != BF_PLUGIN_MAGIC) fail("the magic of " BF_PLUGIN_SYMBOL " is wrong");
  if (plugin->abi_major != BF_ABI_MAJOR || plugin->abi_minor != BF_ABI_MINOR) {
    fail("is built for ABI " + std::to_string(plugin->abi_major) + "." + std::to_string(plugin->abi_minor) +
         "; this suite tests " + std::to_string(BF_ABI_MAJOR) + "." + std::to_string(BF_ABI_MINOR));
  }
  LoadedPlugin loaded;
  loaded.plugin = plugin;
  loaded.factories = plugin->factories(loader_host().c(), &loaded.count);
  if (loaded.factories == nullptr) fail("gives no factories: " + loader_host().take_error());
  return loaded;
}

bf_elf_note read_note(const std::string& file) {
  const Bytes bytes(file);
  const auto header = bytes.at<Elf64_Ehdr>(0);
  if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0 || header->e_ident[EI_CLASS] != ELFCLASS64)
    fail("is no 64-bit ELF file");
  for (std::uint32_t i = 0; i < header->e_phnum; ++i) {
    const auto segment = bytes.at<Elf64_Phdr>(header->e_phoff + std::uint64_t{i} * header->e_phentsize);
    if (!segment || segment->p_type != PT_NOTE) continue;
    if (const auto note = find_note(bytes, segment->p_offset, segment->p_filesz)) return *note;
  }
  fail("has no ELF note '" BF_NOTE_NAME "'");
}

}  // namespace bodeflow::testing
