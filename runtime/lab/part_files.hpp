#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bodeflow::lab {

/// A file that a part leaves for its launcher.
struct PartFile {
  std::string name;  ///< relative, in the run directory
  std::filesystem::path path;
  std::uint64_t size = 0;
};

/// What the part of `directory` has recorded, and below `epoch_0` and so on what those have that it goes on for.
std::vector<PartFile> files_of(const std::filesystem::path& directory);

/// Hands the file's bytes over, some megabytes at a time, as many as it had when it was listed. False: `take` did not want more.
bool read_in_pieces(const PartFile& file, const std::function<bool(std::span<const std::byte>)>& take);

/// Removes the folders of all these parts.
void remove_folders(const std::filesystem::path& directory);

}  // namespace bodeflow::lab
