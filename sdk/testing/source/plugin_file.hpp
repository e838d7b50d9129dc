#pragma once

#include <bodeflow/abi.h>

#include <string>
#include <vector>

namespace bodeflow::testing {

/// A plugin that is loaded; it stays so until the process ends, because what it made may outlive any handle.
struct LoadedPlugin {
  const bf_plugin* plugin = nullptr;
  const bf_factory* const* factories = nullptr;
  std::uint32_t count = 0;
};

/// Loads a plugin file: all symbols at once, none shared. Throws Failure with the reason.
LoadedPlugin load_plugin(const std::string& file);

/// The descriptor of the ELF note in a file. Throws Failure: no ELF file of this machine's word size, or no note.
bf_elf_note read_note(const std::string& file);

}  // namespace bodeflow::testing
