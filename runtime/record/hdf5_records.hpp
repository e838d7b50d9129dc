#pragma once

#include "plugins/instance.hpp"
#include "record/hdf5_handle.hpp"

namespace bodeflow::record::h5 {

/// A row of the dataset `index` beside the raw `bytes` of a message output.
struct IndexRow {
  std::uint64_t offset;
  std::uint64_t size;
  double time;  ///< seconds
  std::uint64_t sequence;
};

Handle index_type();

/// Grows a dataset by `count` rows (whole in the other dimensions) after its first `rows`, and writes them.
void append(hid_t dataset, hid_t type, std::uint64_t rows, std::uint64_t count, std::uint64_t channels, const void* data);

/// Extents of a dataset.
std::vector<hsize_t> shape_of(hid_t dataset);

/// Reads rows first .. first + count of a dataset of that many channels.
void read_rows(hid_t dataset, hid_t type, std::uint64_t first, std::uint64_t count, std::uint64_t channels, void* data);

/// Rows of an index.
std::vector<IndexRow> read_index(hid_t index, std::uint64_t first, std::uint64_t count);

/// The record of an index row. Throws std::runtime_error where the bytes end before it.
SharedRecord read_record(hid_t bytes, const IndexRow& row);

/// Writes a record as a group `name` below `parent`: its attributes as attributes, its arrays as datasets with their unit,
/// and `record_type`, `record_time` [s].
void write_decoded(hid_t parent, const std::string& name, const SharedRecord& record, double time_s);

}  // namespace bodeflow::record::h5
