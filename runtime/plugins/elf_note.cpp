#include "plugins/elf_note.hpp"

#include <elf.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

namespace bodeflow {
namespace {

using Bytes = std::span<const std::byte>;

#if defined(__x86_64__)
constexpr std::uint16_t kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr std::uint16_t kMachine = EM_AARCH64;
#elif defined(__riscv)
constexpr std::uint16_t kMachine = EM_RISCV;
#endif

/// The part [offset, offset + size) of `bytes`, or nothing where it does not lie inside.
std::optional<Bytes> part(Bytes bytes, std::uint64_t offset, std::uint64_t size) {
  if (offset > bytes.size() || size > bytes.size() - offset) return std::nullopt;
  return bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

template <class T>
std::optional<T> read(Bytes bytes, std::uint64_t offset) {
  const auto source = part(bytes, offset, sizeof(T));
  if (!source) return std::nullopt;
  T value;
  std::memcpy(&value, source->data(), sizeof(T));
  return value;
}

std::uint64_t round_up(std::uint64_t value, std::uint64_t alignment) { return (value + alignment - 1) / alignment * alignment; }

template <std::size_t N>
std::string text(const char (&field)[N]) {
  return std::string(field, strnlen(field, N));
}

ElfNote owned(const bf_elf_note& note) {
  return {note.abi_major, note.abi_minor, text(note.name), text(note.version), text(note.build)};
}

/// Notes that are looked at in a file: a hostile one could name the same bytes tens of thousands of times.
constexpr int kMostNotes = 100000;

/// The SDK's note in a note segment or section; `budget` is what is left of kMostNotes.
std::optional<ElfNote> find_in_notes(Bytes notes, std::uint64_t alignment, int& budget) {
  const std::uint64_t align = alignment == 8 ? 8 : 4;
  constexpr std::string_view kName(BF_NOTE_NAME, sizeof BF_NOTE_NAME);  // with its final zero
  std::uint64_t at = 0;
  while (const auto header = read<Elf64_Nhdr>(notes, at)) {
    if (--budget < 0) return std::nullopt;
    const std::uint64_t name_at = at + sizeof(Elf64_Nhdr);
    const std::uint64_t descriptor_at = round_up(name_at + header->n_namesz, align);
    const auto name = part(notes, name_at, header->n_namesz);
    const auto descriptor = part(notes, descriptor_at, header->n_descsz);
    if (!name || !descriptor) return std::nullopt;
    const bool ours = header->n_type == BF_NOTE_TYPE && name->size() == kName.size() &&
                      std::memcmp(name->data(), kName.data(), kName.size()) == 0;
    if (ours) {
      const auto note = read<bf_elf_note>(*descriptor, 0);
      if (note && note->magic == BF_PLUGIN_MAGIC) return owned(*note);
    }
    at = round_up(descriptor_at + header->n_descsz, align);
  }
  return std::nullopt;
}

std::optional<ElfNote> find_in_segments(Bytes file, const Elf64_Ehdr& header, int& budget) {
  if (header.e_phentsize != sizeof(Elf64_Phdr)) return std::nullopt;
  for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
    const auto table = part(file, header.e_phoff, (i + 1) * sizeof(Elf64_Phdr));
    if (!table) return std::nullopt;
    const auto segment = read<Elf64_Phdr>(*table, i * sizeof(Elf64_Phdr));
    if (segment->p_type != PT_NOTE) continue;
    const auto notes = part(file, segment->p_offset, segment->p_filesz);
    if (!notes) continue;
    if (auto note = find_in_notes(*notes, segment->p_align, budget)) return note;
  }
  return std::nullopt;
}

std::optional<ElfNote> find_in_sections(Bytes file, const Elf64_Ehdr& header, int& budget) {
  if (header.e_shentsize != sizeof(Elf64_Shdr)) return std::nullopt;
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    const auto table = part(file, header.e_shoff, (i + 1) * sizeof(Elf64_Shdr));
    if (!table) return std::nullopt;
    const auto section = read<Elf64_Shdr>(*table, i * sizeof(Elf64_Shdr));
    if (section->sh_type != SHT_NOTE) continue;
    const auto notes = part(file, section->sh_offset, section->sh_size);
    if (!notes) continue;
    if (auto note = find_in_notes(*notes, section->sh_addralign, budget)) return note;
  }
  return std::nullopt;
}

}  // namespace

tl::expected<ElfNote, std::string> read_elf_note(std::span<const std::byte> file) {
  const auto refuse = [](const std::string& why) { return tl::unexpected("is no bodeflow plugin: " + why); };
  if (file.size() < SELFMAG || std::memcmp(file.data(), ELFMAG, SELFMAG) != 0) return refuse("no shared library (ELF file)");
  const auto header = read<Elf64_Ehdr>(file, 0);
  if (!header) return refuse("the file is cut off");
  if (header->e_ident[EI_CLASS] != ELFCLASS64 || header->e_ident[EI_DATA] != ELFDATA2LSB) {
    return refuse("built for another kind of processor (not 64 bits, little endian)");
  }
#if defined(__x86_64__) || defined(__aarch64__) || defined(__riscv)
  if (header->e_machine != kMachine) {
    return refuse(fmt::format("built for another processor (ELF machine {}, this host is {})", header->e_machine, kMachine));
  }
#endif
  if (header->e_type != ET_DYN) return refuse("an ELF file, but no shared library");
  int budget = kMostNotes;
  if (auto note = find_in_segments(file, *header, budget)) return *note;
  if (auto note = find_in_sections(file, *header, budget)) return *note;
  return refuse("it has no note of the bodeflow SDK");
}

std::string abi_problem(std::uint32_t major, std::uint32_t minor) {
  if (major == BF_ABI_MAJOR && minor <= BF_ABI_MINOR) return {};
  return fmt::format("needs plugin ABI {}.{}, this host has {}.{}: {}", major, minor, BF_ABI_MAJOR, BF_ABI_MINOR,
                     major < BF_ABI_MAJOR ? "build the plugin anew" : "update bodeflow");
}

}  // namespace bodeflow
