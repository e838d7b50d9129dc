#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bodeflow::test {

struct Ended {
  int exit_code = -1;  ///< 128 + signal when it was killed
  std::string out;
  std::string err;
};

/// Runs the built command as a user does, in a folder, and gives what it printed. `environment` adds to our own.
Ended run_bodeflow(const std::vector<std::string>& arguments, const std::filesystem::path& folder = ".",
                   const std::vector<std::string>& environment = {});

/// Runs any program.
Ended run_program(const std::vector<std::string>& command, const std::filesystem::path& folder = ".",
                  const std::vector<std::string>& environment = {});

/// A new empty folder that goes away with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

}  // namespace bodeflow::test
