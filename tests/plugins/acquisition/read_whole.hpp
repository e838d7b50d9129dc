#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "acquisition/open_table.hpp"
#include "acquisition/scan.hpp"

namespace bodeflow::test {

/// A file that is gone when the test is over.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& ending) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("bodeflow_acquisition_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ending);
  }
  TemporaryFile(const std::string& ending, const std::string& bytes) : TemporaryFile(ending) { write(bytes); }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
  std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// The selected columns of a table, with what the scan found; or the error, "F" standing for the file's name.
struct Table {
  std::vector<acquisition::Column> columns;
  acquisition::TableSummary summary;
  std::vector<std::vector<double>> values;
  std::string error;
};

/// Scans and then reads, in pieces of seven rows. Without a selection: all columns that do not hold time.
inline Table read_whole(Expected<std::unique_ptr<acquisition::TableReader>> reader, const std::vector<std::string>& names = {},
                        const acquisition::Timing& timing = {}, const acquisition::Part& part = {}) {
  Table t;
  const auto failed = [&t, &reader](const std::string& text) {
    t.error = text;
    if (reader && text.rfind((*reader)->file(), 0) == 0) t.error = "F" + text.substr((*reader)->file().size());
    return t;
  };
  if (!reader) return failed(reader.error().text);
  t.columns = (*reader)->columns();
  std::vector<std::size_t> selected;
  for (const std::string& name : names) {
    const auto found = acquisition::find_column(t.columns, name, (*reader)->leftovers());
    if (!found) return failed(found.error().text);
    selected.push_back(*found);
  }
  for (std::size_t i = 0; i < t.columns.size() && names.empty(); ++i) {
    if (!acquisition::is_time(t.columns[i])) selected.push_back(i);
  }
  const auto time = acquisition::find_time_column(**reader, selected, timing);
  if (!time) return failed(time.error().text);
  auto summary = acquisition::scan_table(**reader, selected, *time, timing, part);
  if (!summary) return failed(summary.error().text);
  t.summary = *summary;
  if (auto started = (*reader)->start(selected, summary->first_row); !started) return failed(started.error().text);
  t.values.resize(selected.size());
  std::vector<std::vector<double>> chunk(selected.size(), std::vector<double>(7));
  std::vector<double*> places;
  for (auto& c : chunk) places.push_back(c.data());
  for (std::int64_t left = summary->rows; left > 0;) {
    const auto got = (*reader)->read(places, static_cast<std::size_t>(std::min<std::int64_t>(left, 7)));
    if (!got) return failed(got.error().text);
    if (*got == 0) return failed("fewer rows than the scan found");
    for (std::size_t c = 0; c < chunk.size(); ++c)
      t.values[c].insert(t.values[c].end(), chunk[c].begin(), chunk[c].begin() + static_cast<std::ptrdiff_t>(*got));
    left -= static_cast<std::int64_t>(*got);
  }
  return t;
}

/// The same of a file, whose path is left out of the error.
inline Table read_file(const std::string& path, const std::vector<std::string>& names = {},
                       const acquisition::Timing& timing = {}, const acquisition::Part& part = {}) {
  Table t = read_whole(acquisition::open_table(path), names, timing, part);
  if (t.error.rfind(path, 0) == 0) t.error = "F" + t.error.substr(path.size());
  return t;
}

}  // namespace bodeflow::test
