#include "record/data_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "record/hdf5_records.hpp"
#include "record/pending_changes.hpp"

namespace bodeflow::record {
namespace {

using h5::Handle;

/// The library sleeps twice as long from one attempt to the next, 1 ns at first: about a second for what is damaged, where
/// its default of 100 would take for ever.
constexpr unsigned kReadAttempts = 30;

Handle open_dataset(hid_t file, const std::string& path) {
  return {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "can't open '/" + path + "'"};
}

Origin read_origin(hid_t object) {
  return {h5::get_text(object, "phase"), static_cast<int>(h5::get_integer(object, "repeat")), h5::get_text(object, "block"),
          h5::get_text(object, "port")};
}

std::uint32_t element_of(hid_t dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose, "can't read a dataset's type");
  return H5Tget_class(type.id()) == H5T_COMPOUND ? BF_C64 : BF_F64;
}

Rate read_rate(hid_t dataset) {
  const Handle attribute(H5Aopen(dataset, "sample_rate_fraction", H5P_DEFAULT), H5Aclose, "can't read the sample rate");
  std::int64_t fraction[2] = {0, 1};
  h5::check(H5Aread(attribute.id(), H5T_NATIVE_INT64, fraction), "can't read the sample rate");
  return fraction[1] > 0 ? Rate(fraction[0], fraction[1]) : Rate();
}

StoredStream read_stream(hid_t file, const std::string& path) {
  const Handle dataset = open_dataset(file, path);
  const auto shape = h5::shape_of(dataset.id());
  if (shape.size() != 2) throw std::runtime_error("'/" + path + "' is not samples x channels");
  StoredStream stream;
  stream.origin = read_origin(dataset.id());
  stream.path = path;
  stream.element = element_of(dataset.id());
  stream.length = shape[0];
  stream.channels = static_cast<std::uint32_t>(shape[1]);
  stream.rate = read_rate(dataset.id());
  stream.unit = h5::get_text(dataset.id(), "unit");
  stream.clock = h5::get_text(dataset.id(), "clock");
  stream.channel_names = h5::get_texts(dataset.id(), "channel_names");
  stream.channel_units = h5::get_texts(dataset.id(), "channel_units");
  stream.first_position = h5::get_integer(dataset.id(), "first_position");
  return stream;
}

/// Index rows whose bytes are there: a kill may come between the two.
std::uint64_t whole_records(hid_t bytes, hid_t index) {
  const std::uint64_t held = h5::shape_of(bytes).at(0);
  std::uint64_t count = h5::shape_of(index).at(0);
  while (count > 0) {
    const h5::IndexRow row = h5::read_index(index, count - 1, 1).front();
    if (row.offset <= held && row.size <= held - row.offset) break;
    --count;
  }
  return count;
}

StoredRecords read_records(hid_t file, const std::string& path) {
  const Handle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, "can't open '/" + path + "'");
  return {read_origin(group.id()), path,
          whole_records(open_dataset(file, path + "/bytes").id(), open_dataset(file, path + "/index").id())};
}

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<std::string> links_of(hid_t file, const std::string& path) {
  std::vector<std::string> names;
  const Handle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, "can't open '/" + path + "'");
  h5::check(H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names), "can't list '/" + path + "'");
  for (auto& name : names) name = path + "/" + name;
  return names;
}

bool is_dataset(hid_t file, const std::string& path) {
  const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "can't open '/" + path + "'");
  return H5Iget_type(object.id()) == H5I_DATASET;
}

template <class Stored>
const Stored* find(const std::vector<Stored>& all, const std::string& key) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Stored& one) { return key_of(one.origin) == key; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

struct DataFile::State {
  std::filesystem::path path;
  Handle file;
  std::vector<StoredStream> streams;
  std::vector<StoredRecords> records;

  template <class Body>
  auto guarded(Body body) const -> tl::expected<decltype(body()), std::string> {
    const auto held = h5::lock();
    try {
      return body();
    } catch (const std::exception& error) {
      return tl::unexpected(fmt::format("can't read '{}': {}", path.string(), error.what()));
    }
  }

  void open() {
    finish_changes(path);
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "can't set up HDF5");
    h5::check(H5Pset_file_locking(access.id(), false, true), "can't set up HDF5");
    h5::check(H5Pset_metadata_read_attempts(access.id(), kReadAttempts), "can't set up HDF5");
    // The reader's part of single-writer-multiple-reader mode: the writer may be at work, or may have been killed
    file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.id()), H5Fclose, "can't open it");
  }

  void list() {
    for (const auto& path_in_file : links_of(file.id(), "streams")) {
      if (is_dataset(file.id(), path_in_file)) {
        streams.push_back(read_stream(file.id(), path_in_file));
        continue;
      }
      for (const auto& inner : links_of(file.id(), path_in_file)) streams.push_back(read_stream(file.id(), inner));
    }
    for (const auto& path_in_file : links_of(file.id(), "records")) {
      if (H5Lexists(file.id(), (path_in_file + "/index").c_str(), H5P_DEFAULT) > 0) {
        records.push_back(read_records(file.id(), path_in_file));
        continue;
      }
      for (const auto& inner : links_of(file.id(), path_in_file)) records.push_back(read_records(file.id(), inner));
    }
  }
};

DataFile::DataFile() = default;

DataFile::~DataFile() {
  if (!state_) return;
  const auto held = h5::lock();
  state_->file.reset();
}

tl::expected<std::unique_ptr<DataFile>, std::string> DataFile::open(const std::filesystem::path& path) {
  std::unique_ptr<DataFile> file(new DataFile);
  file->state_ = std::make_unique<State>();
  file->state_->path = path;
  const auto opened = file->state_->guarded([&] {
    file->state_->open();
    file->state_->list();
    return true;
  });
  if (!opened) return tl::unexpected(opened.error());
  return file;
}

const std::vector<StoredStream>& DataFile::streams() const { return state_->streams; }
const std::vector<StoredRecords>& DataFile::records() const { return state_->records; }
const StoredStream* DataFile::stream(const std::string& key) const { return find(state_->streams, key); }
const StoredRecords* DataFile::records_of(const std::string& key) const { return find(state_->records, key); }

tl::expected<std::vector<double>, std::string> DataFile::read(const StoredStream& stream, std::uint64_t first,
                                                              std::uint64_t count) const {
  return state_->guarded([&] {
    if (first > stream.length || count > stream.length - first)
      throw std::runtime_error(fmt::format("samples {} to {} of '{}' are asked for, it has {}", first, first + count,
                                           key_of(stream.origin), stream.length));
    const std::uint64_t parts = stream.element == BF_C64 ? 2 : 1;
    std::vector<double> values(count * stream.channels * parts);
    const Handle dataset = open_dataset(state_->file.id(), stream.path);
    h5::read_rows(dataset.id(), h5::element_type(stream.element).id(), first, count, stream.channels, values.data());
    return values;
  });
}

tl::expected<std::vector<TimedRecord>, std::string> DataFile::read(const StoredRecords& records, std::uint64_t first,
                                                                   std::uint64_t count) const {
  return state_->guarded([&] {
    if (first > records.count || count > records.count - first)
      throw std::runtime_error(fmt::format("records {} to {} of '{}' are asked for, it has {}", first, first + count,
                                           key_of(records.origin), records.count));
    const Handle bytes = open_dataset(state_->file.id(), records.path + "/bytes");
    const Handle index = open_dataset(state_->file.id(), records.path + "/index");
    std::vector<TimedRecord> read;
    for (const auto& row : h5::read_index(index.id(), first, count)) read.push_back({h5::read_record(bytes.id(), row), row.time});
    return read;
  });
}

}  // namespace bodeflow::record
