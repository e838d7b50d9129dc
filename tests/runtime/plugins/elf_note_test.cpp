#include "plugins/elf_note.hpp"

#include <elf.h>

#include <cstring>
#include <random>

#include "catch.hpp"
#include "plugins/file_bytes.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

using Bytes = std::vector<std::byte>;

Bytes fixture_bytes(const std::string& name) { return file_bytes(fixture(name)).value(); }

Bytes bytes_of(const std::string& text) {
  Bytes bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

template <class Change>
Bytes with_header(Bytes bytes, Change change) {
  Elf64_Ehdr header;
  std::memcpy(&header, bytes.data(), sizeof header);
  change(header);
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

std::string refusal(const Bytes& bytes) {
  const auto note = read_elf_note(bytes);
  return note ? "accepted" : note.error();
}

}  // namespace

TEST_CASE("the note of a plugin names its ABI, name, version and build") {
  const auto note = read_elf_note(fixture_bytes("good"));
  REQUIRE(note);
  CHECK(note->abi_major == BF_ABI_MAJOR);
  CHECK(note->abi_minor == BF_ABI_MINOR);
  CHECK(note->name == "good");
  CHECK(note->version == "1.0.0");
  CHECK_FALSE(note->build.empty());
}

TEST_CASE("a stripped plugin still has its note, and one without either of the ELF tables too") {
  CHECK(read_elf_note(fixture_bytes("stripped")).value().name == "good");
  const Bytes good = fixture_bytes("good");
  CHECK(refusal(with_header(good, [](Elf64_Ehdr& h) { h.e_shoff = h.e_shnum = h.e_shstrndx = 0; })) == "accepted");
  CHECK(refusal(with_header(good, [](Elf64_Ehdr& h) { h.e_phoff = h.e_phnum = 0; })) == "accepted");
  CHECK(refusal(with_header(good, [](Elf64_Ehdr& h) { h.e_shnum = h.e_phnum = 0; })) ==
        "is no bodeflow plugin: it has no note of the bodeflow SDK");
}

TEST_CASE("a foreign file is refused with what it is") {
  CHECK(refusal({}) == "is no bodeflow plugin: no shared library (ELF file)");
  CHECK(refusal(bytes_of("title: a graph\n")) == "is no bodeflow plugin: no shared library (ELF file)");
  CHECK(refusal(bytes_of("\177ELF")) == "is no bodeflow plugin: the file is cut off");
  CHECK(refusal(fixture_bytes("no_note")) == "is no bodeflow plugin: it has no note of the bodeflow SDK");
  const Bytes good = fixture_bytes("good");
  CHECK(refusal(with_header(good, [](Elf64_Ehdr& h) { h.e_ident[EI_CLASS] = ELFCLASS32; })) ==
        "is no bodeflow plugin: built for another kind of processor (not 64 bits, little endian)");
  CHECK(refusal(with_header(good, [](Elf64_Ehdr& h) { h.e_type = ET_REL; })) ==
        "is no bodeflow plugin: an ELF file, but no shared library");
#if defined(__x86_64__)
  CHECK(refusal(with_header(good, [](Elf64_Ehdr& h) { h.e_machine = EM_AARCH64; })) ==
        "is no bodeflow plugin: built for another processor (ELF machine 183, this host is 62)");
#endif
}

TEST_CASE("a plugin that is cut off anywhere is refused or still read, never read beyond its end") {
  const Bytes good = fixture_bytes("good");
  for (std::size_t size = 0; size < good.size(); size += size < 8192 ? 7 : 1021) {
    const Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    const auto note = read_elf_note(cut);
    if (note) CHECK(note->name == "good");
  }
}

TEST_CASE("hostile changes of the ELF tables and notes are survived") {
  const Bytes good = fixture_bytes("good");
  std::mt19937_64 random(7);
  int refused = 0;
  for (int round = 0; round < 20000; ++round) {
    Bytes changed(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(good.size(), 2048)));
    for (int k = 0; k < 4; ++k) changed[random() % 1024] = static_cast<std::byte>(random() % 4 == 0 ? 0xFF : random());
    std::memcpy(changed.data(), good.data(), EI_NIDENT + 4);
    refused += read_elf_note(changed) ? 0 : 1;
  }
  CHECK(refused > 0);
  CHECK(refused < 20000);
}

TEST_CASE("a plugin needs the host's major version of the ABI, and a minor one that is not newer") {
  for (std::uint32_t minor = 0; minor <= BF_ABI_MINOR; ++minor) CHECK(abi_problem(BF_ABI_MAJOR, minor).empty());
  CHECK(abi_problem(BF_ABI_MAJOR, BF_ABI_MINOR + 1) == "needs plugin ABI 1.1, this host has 1.0: update bodeflow");
  CHECK(abi_problem(2, 0) == "needs plugin ABI 2.0, this host has 1.0: update bodeflow");
  CHECK(abi_problem(0, 3) == "needs plugin ABI 0.3, this host has 1.0: build the plugin anew");
}
