#pragma once

#include "scan.hpp"

namespace bodeflow::acquisition {

/// What an import says: one text to inform, and warnings.
struct ImportReport {
  std::string found;  ///< rows, rate, duration, gaps, remarks, columns with units and ranges, what was not read
  std::vector<std::string> warnings;
};

/// The report on the selected columns of a file. Warned of: columns that look clipped, columns that are constant.
ImportReport report_import(const TableReader& table, std::span<const std::size_t> selected, std::optional<std::size_t> time,
                           const TableSummary& summary);

}  // namespace bodeflow::acquisition
