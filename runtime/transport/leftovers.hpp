#pragma once

#include <filesystem>

namespace bodeflow::transport {

/// How many files of Fast DDS in `folder` were removed: those of this user whose owners have died. An owner holds a lock on the
/// file with the ending _el or _sl; files younger than two seconds are left, since their owner may not have locked them yet.
int remove_leftovers(const std::filesystem::path& folder = "/dev/shm");

}  // namespace bodeflow::transport
