#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"

/// A bench that hides effects proves something of a tracer that finds them only if both are written apart from each other.

namespace fs = std::filesystem;
using Names = std::set<std::string>;

namespace {

const fs::path kSource = BODEFLOW_SOURCE_DIR;
const fs::path kPlugins = kSource / "plugins";

// What both may use: records that cross between blocks. The mathematics of sdk/numerics lies outside of plugins.
constexpr const char* kShared = "records";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<fs::path> sources_of(const std::string& family) {
  std::vector<fs::path> files;
  if (!fs::exists(kPlugins / family)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(kPlugins / family)) {
    const std::string end = entry.path().extension();
    if (end == ".cpp" || end == ".hpp" || end == ".h") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The file of this tree that a line `#include` names, or nothing for other lines and foreign files.
fs::path included(const std::string& line, const fs::path& from, const std::string& family) {
  const auto hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) return {};
  const auto open = line.find_first_of("\"<", hash), close = line.find_first_of("\">", open + 1);
  if (open == std::string::npos || close == std::string::npos) return {};
  const std::string name = line.substr(open + 1, close - open - 1);
  for (const fs::path& folder :
       {from.parent_path(), kPlugins / family, kPlugins, kSource / "sdk/include", kSource / "sdk/numerics/include"}) {
    if (fs::is_regular_file(folder / name)) return fs::canonical(folder / name);
  }
  return {};
}

/// All files of this tree that the sources of a family include, whatever the depth, and these sources.
std::set<fs::path> reached_from(const std::string& family) {
  std::set<fs::path> reached;
  std::vector<fs::path> open = sources_of(family);
  while (!open.empty()) {
    const fs::path file = fs::canonical(open.back());
    open.pop_back();
    if (!reached.insert(file).second) continue;
    for (const std::string& line : lines_of(file)) {
      if (const fs::path next = included(line, file, family); !next.empty()) open.push_back(next);
    }
  }
  return reached;
}

/// The families of plugins that files belong to.
Names families_of(const std::set<fs::path>& files) {
  Names families;
  for (const fs::path& file : files) {
    const fs::path place = fs::relative(file, fs::canonical(kPlugins));
    if (*place.begin() != "..") families.insert(*place.begin());
  }
  return families;
}

/// Lines that say something, without indentation and comments.
std::vector<std::string> statements_of(const fs::path& file) {
  std::vector<std::string> statements;
  for (std::string line : lines_of(file)) {
    line.erase(std::min(line.find("//"), line.size()));
    line.erase(0, std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.size() > 12 && line[0] != '#' && line.compare(0, 9, "namespace") != 0) statements.push_back(line);
  }
  return statements;
}

/// Runs of so many statements in a row in the sources of a family, and where each stands.
std::map<std::string, std::string> passages_of(const std::string& family, std::size_t length) {
  std::map<std::string, std::string> passages;
  for (const fs::path& file : sources_of(family)) {
    const std::vector<std::string> s = statements_of(file);
    for (std::size_t n = 0; n + length <= s.size(); ++n) {
      std::string passage;
      for (std::size_t k = n; k < n + length; ++k) passage += s[k] + "\n";
      passages.emplace(std::move(passage), file.filename());
    }
  }
  return passages;
}

}  // namespace

TEST_CASE("the hiding bench and the tracer reach no file of each other, directly or through others") {
  const Names drive = families_of(reached_from("drive")), residual = families_of(reached_from("residual"));
  REQUIRE(drive.count("drive") == 1);
  CHECK(drive.count("residual") == 0);
  CHECK(residual.count("drive") == 0);
  Names both;
  std::set_intersection(drive.begin(), drive.end(), residual.begin(), residual.end(), std::inserter(both, both.end()));
  both.erase(kShared);
  CHECK(both == Names{});
}

TEST_CASE("the hiding bench and the tracer do not name each other's namespace or library") {
  for (const auto& [family, other] : {std::pair<std::string, std::string>{"drive", "residual"}, {"residual", "drive"}}) {
    std::vector<fs::path> files = sources_of(family);
    if (fs::exists(kPlugins / family / "CMakeLists.txt")) files.push_back(kPlugins / family / "CMakeLists.txt");
    for (const fs::path& file : files) {
      INFO(file);
      const std::string text = text_of(file);
      CHECK(text.find(other + "::") == std::string::npos);
      CHECK(text.find("bodeflow_" + other) == std::string::npos);
      CHECK(text.find("/" + other + "/") == std::string::npos);
    }
  }
}

TEST_CASE("the hiding bench and the tracer have no passage in common") {
  constexpr std::size_t kLength = 5;
  const auto drive = passages_of("drive", kLength), residual = passages_of("residual", kLength);
  for (const auto& [passage, file] : drive) {
    const auto same = residual.find(passage);
    if (same == residual.end()) continue;
    FAIL_CHECK("drive/" << file << " and residual/" << same->second << " both have\n" << passage);
  }
}

TEST_CASE("no function of the tracer is linked into the bench, and none of the bench into the tracer") {
  // Names as the compiler writes them: length and word, one after the other.
  const std::map<std::string, std::string> mark{{"drive", "8bodeflow5drive"}, {"residual", "8bodeflow8residual"}};
  for (const auto& [family, other] : {std::pair<std::string, std::string>{"drive", "residual"}, {"residual", "drive"}}) {
    const fs::path library = fs::path(BODEFLOW_BUILD_DIR) / "plugins" / (family + ".so");
    if (!fs::exists(library)) {
      WARN(library << " is not built");
      continue;
    }
    const std::string bytes = text_of(library);
    INFO(library);
    CHECK(bytes.find(mark.at(family)) != std::string::npos);
    CHECK(bytes.find(mark.at(other)) == std::string::npos);
  }
}
