#include "file_name.hpp"

#include <algorithm>
#include <bodeflow/error.hpp>
#include <filesystem>

namespace bodeflow::output {

std::string checked_file_name(const std::string& name) {
  const std::filesystem::path path = name;
  const auto refuse = [&](const std::string& why) { fail("file: '" + name + "': " + why); };
  if (name.empty()) refuse("the name is empty");
  if (path.is_absolute()) refuse("the path must be relative: files go into the run directory");
  if (std::find(path.begin(), path.end(), "..") != path.end()) refuse("'..' is not allowed: files go into the run directory");
  if (!path.has_filename() || path.filename() == ".") refuse("names a folder, not a file");
  return name;
}

}  // namespace bodeflow::output
