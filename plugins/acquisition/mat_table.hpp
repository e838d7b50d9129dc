#pragma once

#include <memory>

#include "table.hpp"

namespace bodeflow::acquisition {

/// A reader of a MATLAB file, v5 to v7 (v7.3 is HDF5, see open_hdf5). Numeric vectors are columns named by their variable,
/// matrices give the columns `name[1]`, `name[2]` ...; the fields of a struct are named `s.u`. A single number `Ts` [s] or
/// `Fs` [Hz] states the rate of the columns beside it. The columns that are read are held in memory; the format itself ends
/// at 2 GiB a variable. Values become doubles: integers beyond 2^53 lose digits.
/// Error: no MATLAB file, v4, cut off, no column in it.
Expected<std::unique_ptr<TableReader>> open_mat(const std::string& path);

}  // namespace bodeflow::acquisition
