#include "mat_table.hpp"

#include <algorithm>
#include <bodeflow/utf8.hpp>
#include <list>
#include <map>

#include "mat_layout.hpp"
#include "mat_variable.hpp"
#include "printable.hpp"

namespace bodeflow::acquisition {
namespace {

// Numbers of a column that are read at a time.
constexpr std::size_t kBlock = std::size_t{1} << 14;

Unexpected<Error> forward(const Error& e) { return {e}; }

/// A column: the numbers `first` to `first + rows` of an array.
struct MatColumn {
  MatExtent extent;
  std::string variable;
  MatNumber type;
  std::int64_t position;  // of the array's numbers
  std::int64_t first, rows;
};

/// Reads one column, with its own place in the file.
class Cursor {
 public:
  static Expected<std::unique_ptr<Cursor>> open(const OpenSource& open, const MatColumn& column, bool big_endian,
                                                std::int64_t row);

  Expected<void> read(double* to, std::size_t count);

 private:
  Cursor(std::unique_ptr<ByteSource> source, const MatColumn& column, bool big_endian, std::int64_t row)
      : source_(std::move(source)), column_(column), big_endian_(big_endian), row_(row) {}

  std::unique_ptr<ByteSource> source_;
  std::unique_ptr<MatStream> stream_;
  const MatColumn& column_;
  bool big_endian_;
  std::int64_t row_;
  std::vector<char> bytes_;
};

Expected<std::unique_ptr<Cursor>> Cursor::open(const OpenSource& open, const MatColumn& column, bool big_endian,
                                               std::int64_t row) {
  auto source = open();
  if (!source) return forward(source.error());
  std::unique_ptr<Cursor> cursor(new Cursor(std::move(*source), column, big_endian, row));
  auto stream = open_mat_stream(*cursor->source_, column.extent);
  if (!stream) return forward(stream.error());
  cursor->stream_ = std::move(*stream);
  const auto size = static_cast<std::int64_t>(size_of(column.type));
  if (auto done = cursor->stream_->skip_to(column.position + (column.first + row) * size); !done) return forward(done.error());
  return cursor;
}

Expected<void> Cursor::read(double* to, std::size_t count) {
  const std::size_t size = size_of(column_.type);
  for (std::size_t done = 0; done < count;) {
    const std::size_t part = std::min(count - done, kBlock);
    bytes_.resize(part * size);
    if (auto read = stream_->read(bytes_.data(), bytes_.size()); !read) return read;
    convert(column_.type, big_endian_, bytes_, to + done);
    done += part;
  }
  row_ += static_cast<std::int64_t>(count);
  return row_ == column_.rows ? stream_->verify() : Expected<void>();
}

class MatReader final : public TableReader {
 public:
  MatReader(OpenSource open, std::string name) : open_(std::move(open)), name_(std::move(name)) {}

  Expected<void> open();
  const std::string& file() const override { return name_; }
  const std::vector<Column>& columns() const override { return columns_; }
  const std::vector<Leftover>& leftovers() const override { return leftovers_; }
  Expected<void> start(std::span<const std::size_t> selected, std::int64_t first_row) override;
  Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) override;
  std::string place(std::size_t n) const override {
    return name_ + ": row " + std::to_string(row_ - last_read_ + static_cast<std::int64_t>(n) + 1);
  }

 private:
  Expected<void> list(ByteSource& source);
  Expected<void> add(const MatArray& array, const MatExtent& extent, MatStream& stream);
  Expected<bool> add_rate(const MatArray& array, MatStream& stream);
  void add_columns(const MatArray& array, const MatExtent& extent);
  Unexpected<Error> refuse(const MatColumn& column, const Error& e) const {
    return unexpected(name_ + ": variable '" + column.variable + "' is damaged: " + e.text);
  }

  OpenSource open_;
  std::string name_;
  MatLayout layout_;
  std::vector<Column> columns_;
  std::vector<MatColumn> places_;
  std::vector<Leftover> leftovers_;
  std::map<std::string, Rate> stated_;  // by struct
  std::vector<std::size_t> selected_;
  std::vector<std::unique_ptr<Cursor>> cursors_;
  std::int64_t row_ = 0, rows_ = 0, last_read_ = 0;
};

std::string struct_of(const std::string& name) {
  const auto point = name.rfind('.');
  return point == std::string::npos ? "" : name.substr(0, point);
}

/// Takes a single number that states the rate; false for others.
Expected<bool> MatReader::add_rate(const MatArray& array, MatStream& stream) {
  const std::string branch = struct_of(array.name);
  const std::string last = array.name.substr(branch.empty() ? 0 : branch.size() + 1);
  if (last != "Ts" && last != "Fs") return false;
  char bytes[8] = {};
  const std::size_t size = size_of(array.type);
  if (auto done = stream.skip_to(array.position); !done) return forward(done.error());
  if (auto done = stream.read(bytes, size); !done) return forward(done.error());
  double value = 0.0;
  convert(array.type, layout_.big_endian, {bytes, size}, &value);
  const Rate rate = Rate::from_hz(last == "Ts" ? 1.0 / value : value);
  if (!rate.known()) return false;
  const auto [before, fresh] = stated_.emplace(branch, rate);
  if (!fresh && before->second != rate) return unexpected("'Ts' and 'Fs' state different sampling rates");
  return true;
}

void MatReader::add_columns(const MatArray& array, const MatExtent& extent) {
  const bool vector = array.shape[0] == 1 || array.shape[1] == 1;
  const auto rows = static_cast<std::int64_t>(vector ? array.count : array.shape[0]);
  const std::size_t columns = vector ? 1 : array.shape[1];
  const std::string name = printable(array.name);
  for (std::size_t c = 0; c < columns; ++c) {
    Column column;
    column.header = column.name = vector ? name : name + "[" + std::to_string(c + 1) + "]";
    column.rows = rows;
    columns_.push_back(std::move(column));
    places_.push_back({extent, array.name, array.type, array.position, static_cast<std::int64_t>(c) * rows, rows});
  }
}

Expected<void> MatReader::add(const MatArray& array, const MatExtent& extent, MatStream& stream) {
  if (array.name.empty()) return {};
  if (!is_text(array.name)) {
    leftovers_.push_back({printable(array.name), "has a name that is not UTF-8 text"});
    return {};
  }
  std::string why = array.why;
  if (why.empty() && array.count == 1) {
    const auto taken = add_rate(array, stream);
    if (!taken) return forward(taken.error());
    if (*taken) return {};
    why = "is a single number, no column";
  }
  if (why.empty() && array.shape.size() > 2)
    why = "has " + std::to_string(array.shape.size()) + " dimensions; read are one or two";
  if (why.empty() && array.shape[1] > kMostColumns && array.shape[0] > 1)
    why = "has " + std::to_string(array.shape[1]) + " columns and " + std::to_string(array.shape[0]) +
          " rows; is it stored the other way round? (read are up to " + std::to_string(kMostColumns) + " columns)";
  if (why.empty()) {
    add_columns(array, extent);
  } else {
    leftovers_.push_back({printable(array.name), why});
  }
  return {};
}

Expected<void> MatReader::list(ByteSource& source) {
  auto layout = read_mat_layout(source);
  if (!layout) return forward(layout.error());
  if (layout->kind == MatKind::v73) return unexpected("is of MATLAB's kind v7.3");
  layout_ = std::move(*layout);
  for (const MatExtent& extent : layout_.variables) {
    auto stream = open_mat_stream(source, extent);
    if (!stream) return forward(stream.error());
    const auto arrays = read_mat_variable(**stream, layout_.big_endian);
    if (!arrays) return forward(arrays.error());
    for (const MatArray& array : *arrays) {
      auto again = open_mat_stream(source, extent);
      if (!again) return forward(again.error());
      if (auto done = add(array, extent, **again); !done) return done;
    }
  }
  return {};
}

Expected<void> MatReader::open() {
  auto source = open_();
  if (!source) return unexpected(name_ + ": " + source.error().text);
  if (auto done = list(**source); !done) return unexpected(name_ + ": " + done.error().text);
  if (columns_.empty()) {
    std::string text = name_ + ": no array that can be a column";
    if (!leftovers_.empty()) text += ": '" + leftovers_.front().name + "' " + leftovers_.front().why;
    return unexpected(text);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto stated = stated_.find(struct_of(places_[i].variable));
    if (stated != stated_.end()) columns_[i].rate = stated->second;
  }
  return {};
}

Expected<void> MatReader::start(std::span<const std::size_t> selected, std::int64_t first_row) {
  rows_ = selected.empty() ? 0 : columns_[selected.front()].rows;
  row_ = std::min(first_row, rows_);
  last_read_ = 0;
  selected_.assign(selected.begin(), selected.end());
  cursors_.clear();
  for (const std::size_t c : selected_) {
    auto cursor = Cursor::open(open_, places_[c], layout_.big_endian, row_);
    if (!cursor) return refuse(places_[c], cursor.error());
    cursors_.push_back(std::move(*cursor));
  }
  return {};
}

Expected<std::size_t> MatReader::read(std::span<double* const> channels, std::size_t count) {
  last_read_ = std::min(static_cast<std::int64_t>(count), rows_ - row_);
  for (std::size_t c = 0; c < cursors_.size() && last_read_ > 0; ++c) {
    auto done = cursors_[c]->read(channels[c], static_cast<std::size_t>(last_read_));
    if (!done) return refuse(places_[selected_[c]], done.error());
  }
  row_ += last_read_;
  return static_cast<std::size_t>(last_read_);
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_mat(OpenSource open, const std::string& name) {
  auto reader = std::make_unique<MatReader>(std::move(open), name);
  if (auto done = reader->open(); !done) return forward(done.error());
  return std::unique_ptr<TableReader>(std::move(reader));
}

Expected<bool> is_mat73(const std::string& path) {
  auto source = open_file(path);
  if (!source) return unexpected(path + ": " + source.error().text);
  const auto layout = read_mat_layout(**source);
  if (!layout) return unexpected(path + ": " + layout.error().text);
  return layout->kind == MatKind::v73;
}

}  // namespace bodeflow::acquisition
