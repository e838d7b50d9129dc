#pragma once

#include <functional>
#include <memory>

#include "byte_source.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {

/// A reader of a MATLAB file, v5 to v7. Numeric vectors are columns named by their variable, matrices give the columns
/// `name[1]`, `name[2]` ...; the fields of a struct are named `s.u`. A single number `Ts` [s] or `Fs` [Hz] states the rate of
/// the columns beside it. Values become doubles: integers beyond 2^53 lose digits.
/// Error: no MATLAB file, v4, v7.3 (HDF5: see open_hdf5), cut off, damaged, no column in it.
Expected<std::unique_ptr<TableReader>> open_mat(OpenSource open, const std::string& name);

/// Whether a file is of MATLAB's kind v7.3. Error: it can't be opened, or is no MATLAB file.
Expected<bool> is_mat73(const std::string& path);

}  // namespace bodeflow::acquisition
