#include "record/output_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace bodeflow::record {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 10> kOwnNames = {"graph.yaml", "plan.json",   "manifest.json", "events.jsonl", "log.txt",
                                                   "data.h5",    "result.json", "report.html",   "plots",        "sweep"};

/// Why a name can't be used, whatever else is in the directory; "" : it can.
std::string refusal(const fs::path& path) {
  if (path.empty()) return "the name of the file is empty";
  if (path.is_absolute()) return "the path must be relative: files go into the run directory";
  if (std::find(path.begin(), path.end(), "..") != path.end()) return "'..' is not allowed: files go into the run directory";
  if (!path.has_filename() || path.filename() == ".") return "it names a folder, not a file";
  const std::string first = path.lexically_normal().begin()->string();
  if (std::find(kOwnNames.begin(), kOwnNames.end(), first) != kOwnNames.end()) return "the run itself writes that name";
  return "";
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

/// True where a symbolic link on the way ends outside of `root`, or nowhere. Looked at before folders are made.
bool leaves(const fs::path& root, const fs::path& relative) {
  fs::path place = root;
  for (const auto& step : relative) {
    place /= step;
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(place, error))) continue;
    const fs::path target = fs::canonical(place, error);
    if (error || !lies_in(target, root)) return true;
  }
  return false;
}

/// "name.csv" in its k-th phase: "name@k.csv".
fs::path numbered(const fs::path& path, int k) {
  if (k == 1) return path;
  return path.parent_path() / fmt::format("{}@{}{}", path.stem().string(), k, path.extension().string());
}

}  // namespace

tl::expected<std::string, std::string> OutputFiles::claim(const std::string& block, const std::string& name) {
  const auto refuse = [&](const std::string& reason) {
    return tl::unexpected(fmt::format("output file '{}': {}", name, reason));
  };
  if (const std::string reason = refusal(name); !reason.empty()) return refuse(reason);

  const fs::path normal = fs::path(name).lexically_normal();
  const auto known = claims_.find(normal.string());
  if (known != claims_.end() && (known->second.block != block || known->second.phase == phase_))
    return refuse(fmt::format("block '{}' writes it already", known->second.block));
  const int times = known == claims_.end() ? 1 : known->second.times + 1;
  const fs::path relative = numbered(normal, times);
  if (times > 1 && claims_.count(relative.string()) > 0)
    return refuse(fmt::format("its next name '{}' is taken by block '{}'", relative.string(), claims_[relative.string()].block));

  std::error_code error;
  const fs::path root = fs::canonical(directory_, error);
  if (error) return refuse("the run directory is gone: " + error.message());
  const fs::path full = root / relative;
  if (leaves(root, relative)) return refuse("a symbolic link leads out of the run directory");
  fs::create_directories(full.parent_path(), error);
  if (error) return refuse(fmt::format("can't make its folder: {}", error.message()));
  if (fs::exists(fs::symlink_status(full, error))) return refuse("it exists in the run directory already");

  claims_[normal.string()] = {block, phase_, times};
  files_.emplace(relative.string(), full);
  return full.string();
}

}  // namespace bodeflow::record
