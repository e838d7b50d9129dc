#pragma once

#include <filesystem>
#include <string>

#include "plugins/description.hpp"

namespace bodeflow {

/// Body of the hidden command `probe-plugin FILE`: loads the plugin in this process and prints its description, or why it
/// is refused, as one line of JSON on standard output (whatever the plugin prints itself goes to standard error).
/// Returns the exit code: 0 for both, 1 when nothing could be printed.
int probe_main(const char* file);

/// The description of a plugin as a child process finds it, called as `command probe-plugin file`; an empty command loads it in
/// this process instead. `refused` tells of crashes and hangs too. Any thread.
PluginDescription probe(const std::filesystem::path& file, const std::filesystem::path& command, double timeout_s);

}  // namespace bodeflow
