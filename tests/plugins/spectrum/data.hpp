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

/// The named columns of a CSV file. Throws Failure with the reader's words. `rate_hz`: 0 where the file has a time column.
inline Table table(const std::string& path, const std::vector<std::string>& names, double rate_hz) {
  auto reader = acquisition::open_table(path);
  if (!reader) fail(reader.error().text);
  std::vector<std::size_t> selected;
  for (const std::string& name : names) selected.push_back(acquisition::find_column((*reader)->columns(), name).value());
  acquisition::Timing timing;
  if (rate_hz > 0.0) timing.rate_hz = rate_hz;
  const auto summary = (*reader)->scan(selected, timing).value();
  Table t;
  t.columns.assign(selected.size(), std::vector<double>(static_cast<std::size_t>(summary.rows)));
  std::vector<double*> places;
  for (auto& c : t.columns) places.push_back(c.data());
  if (auto started = (*reader)->start(selected); !started) fail(started.error().text);
  if ((*reader)->read(places, t.columns.front().size()).value() != t.columns.front().size()) fail("short read");
  return t;
}

/// The same for a file of the shared data (BODEFLOW_DATA, or ../shared/data beside the source tree); nothing, with the reason
/// printed, where it is absent.
inline std::optional<Table> shared_table(const std::string& file, const std::vector<std::string>& names, double rate_hz) {
  const char* given = std::getenv("BODEFLOW_DATA");
  const std::filesystem::path folder = given != nullptr ? given : BODEFLOW_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(folder / file)) {
    std::cout << "skipped: " << (folder / file).string() << " is absent (set BODEFLOW_DATA)\n";
    return std::nullopt;
  }
  return table((folder / file).string(), names, rate_hz);
}

}  // namespace bodeflow::test
