#pragma once

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "acquisition/scan.hpp"

namespace bodeflow::fuzz {

/// Scans a table and reads it: both passes must see the same rows. Every third column is not selected.
inline void read_whole(Expected<std::unique_ptr<acquisition::TableReader>> reader, const acquisition::Timing& timing,
                       const acquisition::Part& part) {
  if (!reader) return;
  std::vector<std::size_t> selected;
  for (std::size_t c = 0; c < (*reader)->columns().size(); ++c) {
    if (!is_time((*reader)->columns()[c]) && c % 3 != 2) selected.push_back(c);
  }
  if (selected.empty() || selected.size() > 1000) return;
  const auto time = find_time_column(**reader, selected, timing);
  if (!time) return;
  const auto summary = scan_table(**reader, selected, *time, timing, part);
  if (!summary) return;
  if (!(*reader)->start(selected, summary->first_row)) std::abort();
  std::vector<std::vector<double>> values(selected.size(), std::vector<double>(16));
  std::vector<double*> places;
  for (auto& v : values) places.push_back(v.data());
  for (std::int64_t left = summary->rows; left > 0;) {
    const auto wanted = static_cast<std::size_t>(left < 16 ? left : 16);
    const auto got = (*reader)->read(places, wanted);
    if (!got || *got != wanted) std::abort();
    left -= static_cast<std::int64_t>(wanted);
  }
}

/// The whole table, a part of it by rows, and a part by time.
inline void read_all_ways(const std::function<Expected<std::unique_ptr<acquisition::TableReader>>()>& open) {
  read_whole(open(), {}, {});
  read_whole(open(), {1000.0, true, "", ""}, {});
  read_whole(open(), {1000.0, true, "", ""}, {2, 3, {}, {}});
  read_whole(open(), {}, {0, {}, 0.001, 0.5});
}

}  // namespace bodeflow::fuzz
