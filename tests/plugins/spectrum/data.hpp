#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/csv.hpp"

namespace bodeflow::test {

/// Columns of a data file, in memory.
struct Table {
  std::vector<std::vector<double>> columns;
  std::int64_t rows() const { return static_cast<std::int64_t>(columns.front().size()); }
};

/// The named columns of a CSV file. Throws Failure with the reader's words.
inline Table table(const std::string& path, const std::vector<std::string>& names) {
  auto source = acquisition::open_file(path);
  if (!source) fail(source.error().text);
  auto reader = acquisition::open_csv(std::move(*source), path);
  if (!reader) fail(reader.error().text);
  std::vector<std::size_t> selected;
  for (const std::string& name : names) selected.push_back(acquisition::find_column((*reader)->columns(), name).value());
  if (auto started = (*reader)->start(selected, 0); !started) fail(started.error().text);
  Table t;
  t.columns.resize(selected.size());
  constexpr std::size_t kRows = 4096;
  for (std::size_t rows = kRows; rows == kRows;) {
    std::vector<double*> places;
    const std::size_t filled = t.columns.front().size();
    for (auto& c : t.columns) {
      c.resize(filled + kRows);
      places.push_back(c.data() + filled);
    }
    rows = (*reader)->read(places, kRows).value();
    for (auto& c : t.columns) c.resize(filled + rows);
  }
  return t;
}

/// The same for a file of the shared data (BODEFLOW_DATA, or ../shared/data beside the source tree); nothing, with the reason
/// printed, where it is absent.
inline std::optional<Table> shared_table(const std::string& file, const std::vector<std::string>& names) {
  const char* given = std::getenv("BODEFLOW_DATA");
  const std::filesystem::path folder = given != nullptr ? given : BODEFLOW_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(folder / file)) {
    std::cout << "skipped: " << (folder / file).string() << " is absent (set BODEFLOW_DATA)\n";
    return std::nullopt;
  }
  return table((folder / file).string(), names);
}

}  // namespace bodeflow::test
