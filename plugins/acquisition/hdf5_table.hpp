#pragma once

#include <memory>

#include "table.hpp"

namespace bodeflow::acquisition {

/// A reader of an HDF5 file, MATLAB's v7.3 files among them: see hdf5_columns.hpp for what is a column. Rows are read through
/// hyperslabs of some megabytes. Values become doubles: integers beyond 2^53 lose digits.
/// Error: not HDF5, cut off, damaged, or no column in it.
Expected<std::unique_ptr<TableReader>> open_hdf5(const std::string& path);

}  // namespace bodeflow::acquisition
