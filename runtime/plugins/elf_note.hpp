#pragma once

#include <bodeflow/abi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>

namespace bodeflow {

/// What the SDK wrote into a plugin file, readable without running it.
struct ElfNote {
  std::uint32_t abi_major = 0;
  std::uint32_t abi_minor = 0;
  std::string name;
  std::string version;
  std::string build;
};

/// The SDK's note in the bytes of a shared library for this processor (ELF64, little endian), found through the program
/// headers or, where there are none, the sections: a stripped file has it too. Nothing outside of `file` is read,
/// whatever the bytes say. Error: "is no bodeflow plugin: ...".
tl::expected<ElfNote, std::string> read_elf_note(std::span<const std::byte> file);

/// Why a plugin of that ABI does not fit this host, or "". While major is 0 the same minor or an older one fits.
std::string abi_problem(std::uint32_t major, std::uint32_t minor);

}  // namespace bodeflow
