#pragma once

#include "scan.hpp"

namespace bodeflow::acquisition {

/// Warnings about columns that are not read as time though they hold it by their unit and their values, which rise in every row
/// of the part: in equal steps that contradict its rate, or with a gap. For tables read without a time column. Such a column is
/// read once; one with text or values that are not finite is none.
std::vector<std::string> overlooked_times(TableReader& table, std::span<const std::size_t> selected, const TableSummary& summary);

}  // namespace bodeflow::acquisition
