#include "hdf5_table.hpp"

#include <algorithm>

#include "hdf5_columns.hpp"
#include "printable.hpp"

namespace bodeflow::acquisition {
namespace {

using h5::Handle;

// Values that are read at a time, of a data set and of all.
constexpr hsize_t kBlock = hsize_t{1} << 18;
constexpr hsize_t kBlocks = hsize_t{1} << 22;
// What the library may hold of data sets stored in chunks, so that each chunk is taken apart only once.
constexpr hsize_t kMostCache = hsize_t{256} << 20;

/// A data set and the columns that are read of it.
struct Source {
  struct Wanted {
    hsize_t column;
    std::size_t channel;
  };

  std::string path;
  Handle dataset;
  Hdf5Place place;
  std::vector<Wanted> wanted;
  hsize_t least = 0, width = 1;  // columns that are read
  hsize_t begin = 0, end = 0;    // rows in the buffer
  hsize_t block = 0;             // rows read at a time
  std::vector<double> values;    // row by row, or column by column where transposed

  void fill(hsize_t row, hsize_t rows);
  void read();
  double value(hsize_t row, hsize_t column) const {
    const hsize_t r = row - begin, c = column - least;
    return values[place.transposed ? c * (end - begin) + r : r * width + c];
  }
};

/// Ends with Failure where the data set is stored through a filter that this library does not have.
void check_filters(const Source& s) {
  const std::string what = "data set '" + printable(s.path) + "'";
  const Handle creation(H5Dget_create_plist(s.dataset.id()), H5Pclose, what + " can't be read");
  const int filters = H5Pget_nfilters(creation.id());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    char name[64] = "";
    const H5Z_filter_t filter =
        H5Pget_filter2(creation.id(), static_cast<unsigned>(i), &flags, &values, nullptr, sizeof name - 1, name, &config);
    if (filter < 0 || H5Zfilter_avail(filter) > 0) continue;
    fail(what + " is compressed with filter " + (*name == '\0' ? "" : "'" + printable(name) + "' ") + "(" +
         std::to_string(filter) + "), which is not available here; store it with gzip");
  }
}

void Source::fill(hsize_t row, hsize_t rows) {
  begin = row;
  end = std::min(row + block, rows);
  values.resize((end - begin) * width);
  try {
    read();
  } catch (const Failure&) {
    check_filters(*this);
    throw;
  }
}

void Source::read() {
  const hsize_t count = end - begin;
  if (place.flat) {
    h5::read(dataset.id(), {begin}, {count}, values.data());
  } else if (place.transposed) {
    h5::read(dataset.id(), {least, begin}, {width, count}, values.data());
  } else {
    h5::read(dataset.id(), {begin, least}, {count, width}, values.data());
  }
}

/// Bytes of the chunks that one row of the columns touches; 0 where the data set is not stored in chunks.
hsize_t chunk_bytes(hid_t dataset, const Source& s) {
  const std::string what = "data set '" + s.path + "' can't be read";
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, what);
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED) return 0;
  std::vector<hsize_t> chunk(2, 1);
  const int rank = H5Pget_chunk(creation.id(), 2, chunk.data());
  h5::check(rank, what);
  const Handle type(H5Dget_type(dataset), H5Tclose, what);
  const hsize_t across = rank == 1 ? 1 : chunk[s.place.transposed ? 0 : 1];
  const hsize_t chunks = (s.least + s.width - 1) / across - s.least / across + 1;
  return chunk[0] * chunk[1] * H5Tget_size(type.id()) * chunks;
}

// A data set of which fewer chunks were ever written than one in so many is not read: the rest is fill values.
constexpr hsize_t kSparsest = 1000;

/// Ends with Failure for a data set whose values, or nearly all of them, were never written.
void check_written(hid_t dataset, const Source& s) {
  const std::string what = "data set '" + printable(s.path) + "'";
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, what + " can't be read");
  const H5D_layout_t layout = H5Pget_layout(creation.id());
  if (layout == H5D_CONTIGUOUS && H5Pget_external_count(creation.id()) == 0 && H5Dget_storage_size(dataset) == 0)
    fail(what + " holds no values: none was ever written");
  if (layout != H5D_CHUNKED) return;
  std::vector<hsize_t> chunk(2, 1);
  h5::check(H5Pget_chunk(creation.id(), 2, chunk.data()), what + " can't be read");
  const auto shape = h5::shape_of(dataset);
  hsize_t chunks = 1, written = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) chunks *= (shape[i] - 1) / chunk[i] + 1;
  const Handle space(H5Dget_space(dataset), H5Sclose, what + " can't be read");
  h5::check(H5Dget_num_chunks(dataset, space.id(), &written), what + " can't be read");
  if (written == 0) fail(what + " holds no values: none was ever written");
  if (written < chunks / kSparsest)
    fail(what + " has " + std::to_string(chunks) + " chunks of which all but " + std::to_string(written) +
         " hold no values: they were never written");
}

/// The data set opened with room for its chunks, taken from `room`. Ends with Failure where there is not enough.
Handle open_dataset(hid_t file, const Source& s, hsize_t& room) {
  const std::string what = "data set '" + s.path + "' can't be opened";
  Handle dataset(H5Dopen2(file, s.path.c_str(), H5P_DEFAULT), H5Dclose, what);
  check_written(dataset.id(), s);
  const hsize_t bytes = chunk_bytes(dataset.id(), s);
  if (bytes == 0) return dataset;
  if (bytes > room) {
    fail("data set '" + printable(s.path) + "' is stored in chunks of which " + std::to_string(bytes >> 20) +
         " MiB are needed at a time; all columns together may need " + std::to_string(kMostCache >> 20) +
         " MiB; read fewer columns, or store them in smaller chunks");
  }
  room -= bytes;
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, what);
  h5::check(H5Pset_chunk_cache(access.id(), 12421, bytes, 0.75), what);  // a prime number of slots, as its manual advises
  return {H5Dopen2(file, s.path.c_str(), access.id()), H5Dclose, what};
}

class Hdf5Reader final : public TableReader {
 public:
  explicit Hdf5Reader(std::string path) : path_(std::move(path)) {}
  ~Hdf5Reader() override {
    const h5::Quiet quiet;
    sources_.clear();
    opened_ = Handle();
  }

  Expected<void> open();
  const std::string& file() const override { return path_; }
  const std::vector<Column>& columns() const override { return found_.columns; }
  const std::vector<Leftover>& leftovers() const override { return found_.leftovers; }
  Expected<void> start(std::span<const std::size_t> selected, std::int64_t first_row) override;
  Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) override;
  std::string place(std::size_t n) const override {
    return path_ + ": row " + std::to_string(first_of_last_read_ + static_cast<hsize_t>(n) + 1);
  }

 private:
  std::string path_;
  Handle opened_;
  Hdf5Columns found_;
  std::vector<Source> sources_;
  hsize_t row_ = 0, rows_ = 0, first_of_last_read_ = 0;
};

Expected<void> Hdf5Reader::open() {
  return h5::guarded(path_, [this] {
    opened_ = h5::open_file(path_);
    found_ = hdf5_columns(opened_.id());
    if (!found_.columns.empty()) return;
    std::string text = "no data set that can be a column";
    if (!found_.leftovers.empty()) text += ": '" + found_.leftovers.front().name + "' " + found_.leftovers.front().why;
    fail(text);
  });
}

Expected<void> Hdf5Reader::start(std::span<const std::size_t> selected, std::int64_t first_row) {
  return h5::guarded(path_, [&] {
    sources_.clear();
    rows_ = selected.empty() ? 0 : static_cast<hsize_t>(found_.columns[selected.front()].rows);
    row_ = std::min(static_cast<hsize_t>(first_row), rows_);
    for (std::size_t channel = 0; channel < selected.size(); ++channel) {
      const Hdf5Place& place = found_.places[selected[channel]];
      auto s = std::find_if(sources_.begin(), sources_.end(), [&](const Source& one) { return one.path == place.path; });
      if (s == sources_.end()) {
        sources_.emplace_back();
        s = sources_.end() - 1;
        s->path = place.path;
        s->place = place;
      }
      s->wanted.push_back({place.column, channel});
    }
    hsize_t room = kMostCache;
    for (Source& s : sources_) {
      const auto less = [](const Source::Wanted& a, const Source::Wanted& b) { return a.column < b.column; };
      const auto [least, greatest] = std::minmax_element(s.wanted.begin(), s.wanted.end(), less);
      s.least = least->column;
      s.width = greatest->column - least->column + 1;
      s.block = std::max<hsize_t>(std::min(kBlock, kBlocks / sources_.size()) / s.width, 1);
      s.dataset = open_dataset(opened_.id(), s, room);
    }
  });
}

Expected<std::size_t> Hdf5Reader::read(std::span<double* const> channels, std::size_t count) {
  return h5::guarded(path_, [&] {
    first_of_last_read_ = row_;
    const auto rows = static_cast<std::size_t>(std::min<hsize_t>(count, rows_ - row_));
    for (Source& s : sources_) {
      for (std::size_t done = 0; done < rows;) {
        const hsize_t row = row_ + done;
        if (row < s.begin || row >= s.end) s.fill(row, rows_);
        const std::size_t part = std::min(rows - done, static_cast<std::size_t>(s.end - row));
        for (const auto& [column, channel] : s.wanted) {
          for (std::size_t n = 0; n < part; ++n) channels[channel][done + n] = s.value(row + n, column);
        }
        done += part;
      }
    }
    row_ += rows;
    return rows;
  });
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_hdf5(const std::string& path) {
  auto reader = std::make_unique<Hdf5Reader>(path);
  if (auto done = reader->open(); !done) return {Unexpected<Error>{done.error()}};
  return std::unique_ptr<TableReader>(std::move(reader));
}

}  // namespace bodeflow::acquisition
