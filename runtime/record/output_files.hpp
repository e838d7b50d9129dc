#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <tl/expected.hpp>

namespace bodeflow::record {

/// Gives out names of files inside a run directory, each once.
class OutputFiles {
 public:
  explicit OutputFiles(std::filesystem::path directory) : directory_(std::move(directory)) {}

  /// The absolute path for `block`'s file `name`; folders on the way are made. In a later phase or repetition the same block
  /// gets `name@2.csv`, `name@3.csv` ... Error: the name is absolute, leaves the directory (`..`, a symbolic link), is one of
  /// the run's own files, exists, or was given out in this phase or to another block.
  tl::expected<std::string, std::string> claim(const std::string& block, const std::string& name);

  /// The absolute paths given out, by their names in the run directory; not all need have been written.
  const std::map<std::string, std::filesystem::path>& files() const { return files_; }

  /// Another phase or repetition begins.
  void next_phase() { ++phase_; }

 private:
  struct Claim {
    std::string block;
    int phase = 0;
    int times = 1;
  };

  std::filesystem::path directory_;
  std::map<std::string, Claim> claims_;  ///< by name
  std::map<std::string, std::filesystem::path> files_;
  int phase_ = 0;
};

}  // namespace bodeflow::record
