#pragma once

#include <filesystem>

namespace bodeflow::transport {

/// How many files of Fast DDS in `folder` were removed: segments and ports of this user that nobody listens on any more. A
/// listener holds a lock on the file with the ending _el or _sl. Files younger than two seconds are left: their owner may not
/// have locked them yet.
int remove_leftovers(const std::filesystem::path& folder = "/dev/shm");

}  // namespace bodeflow::transport
