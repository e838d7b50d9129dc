#include <cstdlib>
#include <string_view>
#include <system_error>

#include "plugins/registry.hpp"

namespace bodeflow {

std::vector<std::filesystem::path> default_plugin_path() {
  std::vector<std::filesystem::path> path;
  if (const char* listed = std::getenv("BODEFLOW_PLUGIN_PATH")) {
    std::string_view rest(listed);
    while (!rest.empty()) {
      const std::size_t end = rest.find(':');
      if (const std::string_view folder = rest.substr(0, end); !folder.empty()) path.emplace_back(folder);
      rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    }
  }
  std::error_code error;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    const auto prefix = executable.parent_path().parent_path();
    path.push_back(prefix / "plugins");
    path.push_back(prefix / "lib/bodeflow/plugins");
    // Debian keeps libraries below lib/<machine>.
    const auto installed = prefix / BODEFLOW_LIBRARY_FOLDER / "bodeflow/plugins";
    if (installed != path.back()) path.push_back(installed);
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    path.push_back(std::filesystem::path(home) / ".local/lib/bodeflow/plugins");
  }
  return path;
}

}  // namespace bodeflow
