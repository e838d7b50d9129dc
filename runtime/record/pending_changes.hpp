#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bodeflow::record {

/// New content of bytes that a file holds already.
struct PendingChange {
  std::uint64_t address;
  std::vector<unsigned char> bytes;
};

/// Writes changes of old bytes so that a process which is killed at any moment leaves all of them or none: they are written to
/// a file `PATH.pending` first, which is removed when `file`, the descriptor of `path`, has them. Where the disk has no room
/// for it, they are written at once. False: not all are written.
bool write_changes(const std::filesystem::path& path, int file, const std::vector<PendingChange>& changes);

/// Finishes what `write_changes` was killed in; nothing where there is nothing to finish, or where the writer is alive and
/// finishes it by itself. Throws std::runtime_error with the reason where it can't.
void finish_changes(const std::filesystem::path& path);

/// Writes all bytes at `address`, in as many calls as it takes. False: errno tells.
bool write_at(int file, std::uint64_t address, const unsigned char* bytes, std::size_t size);

}  // namespace bodeflow::record
