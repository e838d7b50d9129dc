#include "record/hdf5_records.hpp"

#include <algorithm>
#include <bodeflow/record.hpp>
#include <cstddef>

namespace bodeflow::record::h5 {
namespace {

Handle dataset_space(hid_t dataset) { return {H5Dget_space(dataset), H5Sclose, "can't read a dataset's shape"}; }

/// The rows first .. first + count selected in a dataset of one or two dimensions.
Handle selected(hid_t dataset, std::uint64_t first, std::uint64_t count, std::uint64_t channels) {
  Handle rows = dataset_space(dataset);
  const hsize_t start[2] = {first, 0}, size[2] = {count, channels};
  check(H5Sselect_hyperslab(rows.id(), H5S_SELECT_SET, start, nullptr, size, nullptr), "can't select rows of a dataset");
  return rows;
}

/// A name that `parent` does not have as a link yet.
std::string free_link(hid_t parent, std::string_view name) {
  std::string link = link_name(name);
  while (H5Lexists(parent, link.c_str(), H5P_DEFAULT) > 0) link += '_';
  return link;
}

/// A name that `object` does not have as an attribute yet.
std::string free_attribute(hid_t object, std::string_view name) {
  std::string free(name);
  while (H5Aexists(object, free.c_str()) > 0) free += '_';
  return free;
}

template <class T, class Get>
void put_values(hid_t object, const std::string& name, hid_t type, const AttributeView& attribute, Get get) {
  std::vector<T> values;
  for (std::size_t i = 0; i < attribute.size(); ++i) values.push_back(static_cast<T>(get(i)));
  const T none{};
  const std::vector<hsize_t> shape = attribute.is_list() ? std::vector<hsize_t>{values.size()} : std::vector<hsize_t>{};
  put_raw(object, name.c_str(), type, shape, values.empty() ? &none : values.data());
}

void put_attribute(hid_t object, const AttributeView& a) {
  const std::string name = free_attribute(object, a.name());
  switch (a.kind()) {
    case AttributeKind::boolean:
      return put_values<std::int8_t>(object, name, boolean_type().id(), a, [&](std::size_t i) { return a.boolean(i) ? 1 : 0; });
    case AttributeKind::integer:
      return put_values<std::int64_t>(object, name, H5T_STD_I64LE, a, [&](std::size_t i) { return a.integer(i); });
    case AttributeKind::number:
      return put_values<double>(object, name, H5T_IEEE_F64LE, a, [&](std::size_t i) { return a.number(i); });
    case AttributeKind::text:
      break;
  }
  if (!a.is_list()) return put(object, name.c_str(), a.text());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < a.size(); ++i) texts.emplace_back(a.text(i));
  put(object, name.c_str(), texts);
}

void put_array(hid_t parent, const ArrayView& array) {
  const std::string name = free_link(parent, array.name);
  const std::string what = "can't write the array '" + name + "'";
  const Handle type = element_type(array.element);
  const Handle extent = space(std::vector<hsize_t>(array.shape.begin(), array.shape.end()));
  const Handle dataset(H5Dcreate2(parent, name.c_str(), type.id(), extent.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                       what);
  if (array.size > 0) check(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.data), what);
  put(dataset.id(), "unit", array.unit);
}

}  // namespace

Handle index_type() {
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(IndexRow)), H5Tclose, "can't make a type");
  check(H5Tinsert(type.id(), "offset", offsetof(IndexRow, offset), H5T_STD_U64LE), "can't make a type");
  check(H5Tinsert(type.id(), "size", offsetof(IndexRow, size), H5T_STD_U64LE), "can't make a type");
  check(H5Tinsert(type.id(), "time", offsetof(IndexRow, time), H5T_IEEE_F64LE), "can't make a type");
  check(H5Tinsert(type.id(), "sequence", offsetof(IndexRow, sequence), H5T_STD_U64LE), "can't make a type");
  return type;
}

void append(hid_t dataset, hid_t type, std::uint64_t rows, std::uint64_t count, std::uint64_t channels, const void* data) {
  const hsize_t extent[2] = {rows + count, channels}, size[2] = {count, channels};
  check(H5Dset_extent(dataset, extent), "can't grow a dataset");
  const Handle to = selected(dataset, rows, count, channels);
  const Handle from(H5Screate_simple(H5Sget_simple_extent_ndims(to.id()), size, nullptr), H5Sclose, "can't make a shape");
  check(H5Dwrite(dataset, type, from.id(), to.id(), H5P_DEFAULT, data), "can't write to a dataset");
}

std::vector<hsize_t> shape_of(hid_t dataset) {
  const Handle extent = dataset_space(dataset);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(extent.id()))));
  H5Sget_simple_extent_dims(extent.id(), shape.data(), nullptr);
  return shape;
}

void read_rows(hid_t dataset, hid_t type, std::uint64_t first, std::uint64_t count, std::uint64_t channels, void* data) {
  if (count == 0) return;
  const hsize_t size[2] = {count, channels};
  const Handle from = selected(dataset, first, count, channels);
  const Handle to(H5Screate_simple(H5Sget_simple_extent_ndims(from.id()), size, nullptr), H5Sclose, "can't make a shape");
  check(H5Dread(dataset, type, to.id(), from.id(), H5P_DEFAULT, data), "can't read a dataset");
}

std::vector<IndexRow> read_index(hid_t index, std::uint64_t first, std::uint64_t count) {
  std::vector<IndexRow> rows(count);
  read_rows(index, index_type().id(), first, count, 1, rows.data());
  return rows;
}

SharedRecord read_record(hid_t bytes, const IndexRow& row) {
  const std::uint64_t held = shape_of(bytes).at(0);
  if (row.offset > held || row.size > held - row.offset) throw std::runtime_error("the bytes of a record are cut off");
  std::vector<std::uint8_t> raw(row.size);
  read_rows(bytes, H5T_STD_U8LE, row.offset, row.size, 1, raw.data());
  SharedRecord record = SharedRecord::copy(raw.data(), raw.size());
  if (const auto view = RecordView::check({record.bytes(), record.size()}); !view) throw std::runtime_error(view.error().text);
  return record;
}

void write_decoded(hid_t parent, const std::string& name, const SharedRecord& record, double time_s) {
  const RecordView view(record.bytes());
  const Handle to = group(parent, name);
  put(to.id(), "record_type", view.type());
  put(to.id(), "record_time", time_s);
  for (const auto& attribute : view.attributes()) put_attribute(to.id(), attribute);
  for (const auto& array : view.arrays()) put_array(to.id(), array);
}

}  // namespace bodeflow::record::h5
