#include "lab/part_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "lab/channel.hpp"

namespace bodeflow::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPiece = std::uint64_t{4} << 20;

/// The folders of the part and of those that it goes on for, and what they are called in the run directory.
std::vector<std::pair<fs::path, fs::path>> folders(const fs::path& directory) {
  std::vector<std::pair<fs::path, fs::path>> found{{"", directory}};
  const std::string name = directory.filename().string();
  const auto dash = name.rfind('-');
  if (dash == std::string::npos) return found;
  const std::string run = name.substr(0, dash);
  int own = 0;
  std::from_chars(name.data() + dash + 1, name.data() + name.size(), own);
  for (int epoch = 0; epoch < own; ++epoch)
    if (const fs::path folder = directory.parent_path() / part_name(run, epoch); fs::is_directory(folder))
      found.emplace_back(fmt::format("epoch_{}", epoch), folder);
  return found;
}

}  // namespace

std::vector<PartFile> files_of(const fs::path& directory) {
  std::vector<PartFile> files;
  for (const auto& [name, folder] : folders(directory))
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file())
        files.push_back({(name / fs::relative(entry.path(), folder)).string(), entry.path(), entry.file_size()});
  return files;
}

bool read_in_pieces(const PartFile& file, const std::function<bool(std::span<const std::byte>)>& take) {
  std::ifstream in(file.path, std::ios::binary);
  std::vector<char> piece(std::min(file.size, kPiece));
  for (std::uint64_t done = 0; done < file.size; done += piece.size()) {
    piece.resize(std::min(file.size - done, kPiece));
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if (!take(std::as_bytes(std::span(piece)))) return false;
  }
  return true;
}

void remove_folders(const fs::path& directory) {
  std::error_code error;
  for (const auto& [name, folder] : folders(directory)) fs::remove_all(folder, error);
}

}  // namespace bodeflow::lab
