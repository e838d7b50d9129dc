#include "record/data_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bodeflow/record.hpp>

#include "record/disk_space.hpp"
#include "record/hdf5_deferred.hpp"
#include "record/hdf5_records.hpp"

namespace bodeflow::record {
namespace {

using h5::Handle;

constexpr double kKi = 1024.0;
/// A chunk holds about a second: large enough for fast streams, and slow ones don't rewrite much at each flush.
constexpr double kChunkLeast = 64 * kKi, kChunkMost = 512 * kKi;
constexpr std::uint64_t kIndexChunkRows = 256;
constexpr std::uint64_t kByteChunk = 64 * 1024;
/// Records up to this size are gathered before they are written.
constexpr std::uint64_t kGather = 1024 * 1024;
/// What the file grows by for an object's header, attributes and first index blocks, at most.
constexpr std::uint64_t kObjectBytes = 16 * 1024;

struct Stream {
  Handle dataset, type;
  std::uint64_t rows = 0;
  std::uint64_t channels = 1;
  std::uint64_t row_bytes = 8;
  std::uint64_t chunk_bytes = 0;
};

struct Records {
  std::string path;
  Handle bytes, index;
  std::uint64_t size = 0;
  std::uint64_t count = 0;
};

std::string level_of(const Origin& origin) {
  if (origin.phase.empty()) return "";
  return origin.repeat > 0 ? fmt::format("{}@{}", origin.phase, origin.repeat + 1) : origin.phase;
}

/// Access for appending (metadata in an order that readers can follow), or for adding objects (old bytes change at the close).
/// Without file locks: a reader must not be able to stop a run.
Handle file_access(bool appending) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "can't set up HDF5");
  h5::check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "can't set up HDF5");
  h5::check(H5Pset_file_locking(access.id(), false, true), "can't set up HDF5");
  if (!appending) h5::set_deferred_driver(access.id());
  return access;
}

std::uint64_t chunk_rows(const StreamFacts& facts, std::uint64_t row_bytes) {
  const double per_second = facts.rate.hz() * static_cast<double>(row_bytes);
  const double target = std::clamp(per_second, kChunkLeast, kChunkMost);
  auto rows = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(target) / row_bytes);
  if (facts.length > 0) rows = std::min(rows, static_cast<std::uint64_t>(facts.length));
  return rows;
}

/// A new dataset without rows that can grow; `path` without a leading slash, groups are made on the way.
Handle growing_dataset(hid_t file, const std::string& path, hid_t type, std::vector<hsize_t> chunk) {
  const std::string what = "can't make the dataset '/" + path + "'";
  std::vector<hsize_t> now = chunk, most = chunk;
  now[0] = 0;
  most[0] = H5S_UNLIMITED;
  const Handle extent(H5Screate_simple(static_cast<int>(chunk.size()), now.data(), most.data()), H5Sclose, what);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  h5::check(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()), what);
  h5::check(H5Pset_attr_phase_change(creation.id(), 32, 16), what);  // all attributes in the object's header
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, what);
  h5::check(H5Pset_create_intermediate_group(links.id(), 1), what);
  return {H5Dcreate2(file, path.c_str(), type, extent.id(), links.id(), creation.id(), H5P_DEFAULT), H5Dclose, what};
}

void put_origin(hid_t object, const Origin& origin) {
  h5::put(object, "phase", origin.phase);
  h5::put(object, "repeat", std::int64_t{origin.repeat});
  h5::put(object, "block", origin.block);
  h5::put(object, "port", origin.port);
}

std::string object_path(const char* kind, const Origin& origin) {
  const std::string level = level_of(origin);
  return fmt::format("{}/{}{}", kind, level.empty() ? "" : h5::link_name(level) + "/",
                     h5::link_name(origin.block + "." + origin.port));
}

std::vector<std::string> padded(std::vector<std::string> texts, std::size_t size) {
  texts.resize(size);
  return texts;
}

void make_stream(hid_t file, const StreamTarget& target) {
  const StreamFacts& facts = target.facts;
  const std::uint64_t channels = std::max(1U, facts.channels);
  const std::uint64_t rows = chunk_rows(facts, channels * element_size(facts.element));
  const Handle dataset =
      growing_dataset(file, object_path("streams", target.origin), h5::element_type(facts.element).id(), {rows, channels});
  put_origin(dataset.id(), target.origin);
  h5::put(dataset.id(), "unit", facts.unit);
  h5::put(dataset.id(), "sample_rate", facts.rate.hz());
  const std::int64_t fraction[2] = {facts.rate.num, facts.rate.den};
  h5::put_raw(dataset.id(), "sample_rate_fraction", H5T_STD_I64LE, {2}, fraction);
  h5::put(dataset.id(), "clock", facts.clock);
  h5::put(dataset.id(), "channel_names", padded(facts.channel_names, channels));
  h5::put(dataset.id(), "channel_units",
          facts.channel_units.empty() ? std::vector<std::string>(channels, facts.unit) : padded(facts.channel_units, channels));
  h5::put(dataset.id(), "first_position", std::int64_t{0});
}

void make_records(hid_t file, const Origin& origin) {
  const std::string path = object_path("records", origin);
  growing_dataset(file, path + "/bytes", H5T_STD_U8LE, {kByteChunk});
  growing_dataset(file, path + "/index", h5::index_type().id(), {kIndexChunkRows});
  const Handle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, "can't open '/" + path + "'");
  put_origin(group.id(), origin);
}

}  // namespace

std::string key_of(const Origin& origin) {
  const std::string level = level_of(origin);
  return fmt::format("{}{}{}.{}", level, level.empty() ? "" : ".", origin.block, origin.port);
}

struct DataWriter::State {
  explicit State(std::filesystem::path p) : path(std::move(p)), space(path) {}

  std::filesystem::path path;
  DiskSpace space;
  Handle file;
  std::vector<Stream> streams;
  std::vector<Records> records;

  /// Runs `body` under the lock and turns what it throws into a text with the file's name.
  template <class Body>
  Result guarded(Body body) {
    const auto held = h5::lock();
    try {
      body();
      return {};
    } catch (const SpaceError& error) {
      return tl::unexpected(std::string(error.what()));
    } catch (const std::exception& error) {
      return tl::unexpected(fmt::format("can't write '{}': {}", path.string(), error.what()));
    }
  }

  struct SpaceError : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  void open(bool appending) {
    const Handle access = file_access(appending);
    const unsigned flags = appending ? H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE : H5F_ACC_RDWR;
    file = Handle(H5Fopen(path.c_str(), flags, access.id()), H5Fclose, "can't open it");
  }

  void close() {
    streams.clear();
    records.clear();
    file.close("can't close it");
  }

  /// Makes sure that the file can grow by so many bytes.
  void need(std::uint64_t bytes) {
    void* descriptor = nullptr;
    hsize_t size = 0;
    h5::check(H5Fget_vfd_handle(file.id(), H5P_DEFAULT, &descriptor), "can't ask for its descriptor");
    h5::check(H5Fget_filesize(file.id(), &size), "can't ask for its size");
    if (const auto held = space.ensure(*static_cast<int*>(descriptor), size + bytes); !held) throw SpaceError(held.error());
  }

  void open_stream(const StreamTarget& target) {
    const std::string path_in_file = object_path("streams", target.origin);
    Stream stream;
    stream.dataset =
        Handle(H5Dopen2(file.id(), path_in_file.c_str(), H5P_DEFAULT), H5Dclose, "can't open '/" + path_in_file + "'");
    stream.type = h5::element_type(target.facts.element);
    stream.channels = std::max(1U, target.facts.channels);
    stream.row_bytes = stream.channels * element_size(target.facts.element);
    stream.chunk_bytes = stream.row_bytes * chunk_rows(target.facts, stream.row_bytes);
    streams.push_back(std::move(stream));
  }

  void open_records(const Origin& origin) {
    Records port;
    port.path = object_path("records", origin);
    const auto open = [&](const char* name) {
      return Handle(H5Dopen2(file.id(), (port.path + name).c_str(), H5P_DEFAULT), H5Dclose,
                    "can't open '/" + port.path + name + "'");
    };
    port.bytes = open("/bytes");
    port.index = open("/index");
    records.push_back(std::move(port));
  }

  void append_bytes(Records& port, const void* data, std::uint64_t size) {
    if (size == 0) return;
    need(size + 2 * kByteChunk);
    h5::append(port.bytes.id(), H5T_STD_U8LE, port.size, size, 1, data);
    port.size += size;
  }

  void decode(const std::string& path_in_file) {
    const Handle group = h5::group(file.id(), path_in_file);
    const Handle bytes(H5Dopen2(group.id(), "bytes", H5P_DEFAULT), H5Dclose, "can't open the records");
    const Handle index(H5Dopen2(group.id(), "index", H5P_DEFAULT), H5Dclose, "can't open the records");
    const std::uint64_t count = h5::shape_of(index.id()).at(0);
    const std::uint64_t candidates = std::min(count, kDecodedRecords);
    const auto rows = h5::read_index(index.id(), count - candidates, candidates);
    std::size_t first = rows.size();
    for (std::uint64_t size = 0; first > 0 && size + rows[first - 1].size <= kDecodedBytes; --first) size += rows[first - 1].size;
    for (std::size_t i = first; i < rows.size(); ++i) {
      need(rows[i].size + 4 * kObjectBytes);
      h5::write_decoded(group.id(), std::to_string(rows[i].sequence), h5::read_record(bytes.id(), rows[i]), rows[i].time);
    }
    h5::put(group.id(), "records", static_cast<std::int64_t>(count));
    h5::put(group.id(), "decoded", static_cast<std::int64_t>(rows.size() - first));
    if (rows.size() - first < count)
      h5::put(group.id(), "note",
              fmt::format("only the last {} of {} records stand as groups; 'bytes' and 'index' hold all", rows.size() - first,
                          count));
  }
};

DataWriter::DataWriter() = default;

DataWriter::~DataWriter() {
  if (!state_) return;
  (void)state_->guarded([&] { state_->close(); });
  state_->space.release();
}

tl::expected<std::unique_ptr<DataWriter>, std::string> DataWriter::create(const std::filesystem::path& path) {
  std::unique_ptr<DataWriter> writer(new DataWriter);
  writer->state_ = std::make_unique<State>(path);
  State& state = *writer->state_;
  const auto made = state.guarded([&] {
    if (std::filesystem::exists(path)) throw std::runtime_error("it exists already");
    std::filesystem::path unfinished = path;  // so that the file is whole from its first moment
    unfinished += ".new";
    const Handle access = file_access(false);
    state.file = Handle(H5Fcreate(unfinished.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose, "can't create it");
    h5::put(state.file.id(), "bodeflow", std::int64_t{1});
    h5::group(state.file.id(), "streams");
    h5::group(state.file.id(), "records");
    state.close();
    std::filesystem::rename(unfinished, path);
  });
  if (!made) return tl::unexpected(made.error());
  return writer;
}

DataWriter::Result DataWriter::begin(const std::vector<StreamTarget>& streams, const std::vector<Origin>& records) {
  return state_->guarded([&] {
    state_->open(false);
    state_->need((streams.size() + 3 * records.size()) * kObjectBytes);
    for (const auto& stream : streams) make_stream(state_->file.id(), stream);
    for (const auto& port : records) make_records(state_->file.id(), port);
    state_->close();
    state_->open(true);
    for (const auto& stream : streams) state_->open_stream(stream);
    for (const auto& port : records) state_->open_records(port);
  });
}

DataWriter::Result DataWriter::append_samples(std::size_t stream, const void* rows, std::uint64_t count) {
  return state_->guarded([&] {
    Stream& to = state_->streams.at(stream);
    state_->need(count * to.row_bytes + 2 * to.chunk_bytes);
    h5::append(to.dataset.id(), to.type.id(), to.rows, count, to.channels, rows);
    to.rows += count;
  });
}

DataWriter::Result DataWriter::append_records(std::size_t port, std::span<const TimedRecord> records) {
  return state_->guarded([&] {
    Records& to = state_->records.at(port);
    std::vector<h5::IndexRow> rows;
    std::vector<std::uint8_t> gathered;
    std::uint64_t offset = to.size, sequence = to.count;
    const auto write_gathered = [&] {
      state_->append_bytes(to, gathered.data(), gathered.size());
      gathered.clear();
    };
    for (const auto& [record, time_s] : records) {
      rows.push_back({offset, record.size(), time_s, sequence++});
      offset += record.size();
      if (record.size() >= kGather) {
        write_gathered();
        state_->append_bytes(to, record.bytes(), record.size());
        continue;
      }
      gathered.insert(gathered.end(), record.bytes(), record.bytes() + record.size());
      if (gathered.size() >= kGather) write_gathered();
    }
    write_gathered();
    state_->need(rows.size() * sizeof(h5::IndexRow) + 2 * kIndexChunkRows * sizeof(h5::IndexRow));
    h5::append(to.index.id(), h5::index_type().id(), to.count, rows.size(), 1, rows.data());
    to.count += rows.size();
  });
}

DataWriter::Result DataWriter::flush() {
  return state_->guarded([&] {
    for (const auto& stream : state_->streams) h5::check(H5Dflush(stream.dataset.id()), "can't flush a stream");
    for (const auto& port : state_->records) {  // bytes before the rows that point at them
      h5::check(H5Dflush(port.bytes.id()), "can't flush records");
      h5::check(H5Dflush(port.index.id()), "can't flush records");
    }
  });
}

DataWriter::Result DataWriter::end(bool decode) {
  const auto result = state_->guarded([&] {
    std::vector<std::string> ports;
    for (const auto& port : state_->records)
      if (decode && port.count > 0) ports.push_back(port.path);
    state_->close();
    if (ports.empty()) return;
    state_->open(false);
    for (const auto& port : ports) state_->decode(port);
    state_->close();
  });
  state_->space.release();
  return result;
}

}  // namespace bodeflow::record
