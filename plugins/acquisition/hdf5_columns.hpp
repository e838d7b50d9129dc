#pragma once

#include "hdf5_object.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {

/// Where a column of an HDF5 file stands.
struct Hdf5Place {
  std::string path;         ///< of the data set
  std::size_t column = 0;   ///< in it
  bool transposed = false;  ///< columns x rows, as MATLAB writes
  bool flat = false;        ///< one dimension
};

/// What an HDF5 file holds that a table can show.
struct Hdf5Columns {
  std::vector<Column> columns;
  std::vector<Hdf5Place> places;  ///< one a column
  std::vector<Leftover> leftovers;
};

/// The data sets of a file as columns. A data set with one dimension is a column named by its path, one with rows x columns
/// gives the columns `path[1]`, `path[2]` ... In a file that MATLAB wrote (v7.3) the dimensions stand the other way round, a
/// row is a column too, structs join names by points, and a single number `Ts` [s] or `Fs` [Hz] states the rate of the
/// columns of its struct. In the recording of a run (data.h5) the streams are columns, without "streams/".
/// Units come from the attributes `unit` or `units`, rates from `sample_rate` or `rate` [Hz] of the data set, else of the
/// groups around it. Links to other files are not followed.
/// Ends with Failure when the file is damaged.
Hdf5Columns hdf5_columns(hid_t file);

}  // namespace bodeflow::acquisition
