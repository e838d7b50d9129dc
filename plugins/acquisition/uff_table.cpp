#include "uff_table.hpp"

#include <bodeflow/utf8.hpp>
#include <list>

#include "sampling.hpp"
#include "uff58_values.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr int kTimeResponse = 1;
constexpr int kTime = 17;  // type of an abscissa

Unexpected<Error> place_error(const std::string& file, const TextError& e) {
  std::string text = file;
  if (e.line > 0) text += ":" + std::to_string(e.line);
  if (e.column > 0) text += ":" + std::to_string(e.column);
  return unexpected(text + ": " + e.text);
}

/// Why a function is no column, or "".
std::string why_not_column(const Uff58Function& f) {
  constexpr const char* kKinds[] = {"a general function", "a time response",      "an auto spectrum",
                                    "a cross spectrum",   "a frequency response", "a transmissibility",
                                    "a coherence",        "an autocorrelation",   "a cross correlation"};
  if (f.kind != kTimeResponse && f.abscissa_type != kTime) {
    const std::string kind = f.kind >= 0 && f.kind <= 8 ? kKinds[f.kind] : "a function of type " + std::to_string(f.kind);
    return "is " + kind + ", no signal over time";
  }
  if (f.complex) return "is complex";
  if (!f.even) return "has an uneven abscissa; resample it before";
  if (!(f.step > 0.0)) return "has an abscissa increment of " + number_text(f.step);
  return "";
}

class UffReader final : public TableReader {
 public:
  UffReader(OpenSource open, std::string name) : open_(std::move(open)), name_(std::move(name)) {}

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
  /// A function that is read, with its own place in the file.
  struct Cursor {
    Cursor(std::unique_ptr<ByteSource> bytes, const Uff58Function& f) : source(std::move(bytes)), values(*source, f) {}
    std::unique_ptr<ByteSource> source;
    Uff58Values values;
  };

  void add(const Uff58Function& f, std::size_t number);

  OpenSource open_;
  std::string name_;
  Uff58File found_;
  std::vector<Column> columns_;
  std::vector<std::size_t> functions_;  // of the columns
  std::vector<Leftover> leftovers_;
  std::list<Cursor> cursors_;
  std::int64_t row_ = 0, rows_ = 0, last_read_ = 0;
};

void UffReader::add(const Uff58Function& f, std::size_t number) {
  const std::string header = "f" + std::to_string(number + 1);
  if (const std::string why = why_not_column(f); !why.empty()) {
    leftovers_.push_back({header, why});
    return;
  }
  Column column;
  column.header = header;
  column.name =
      f.response_node == 0 && f.response_direction == 0 ? header : degree_of_freedom(f.response_node, f.response_direction);
  if (is_unit(f.ordinate_unit)) column.unit = f.ordinate_unit;
  const double seconds = seconds_per(f.abscissa_unit).value_or(1.0);
  column.rate = Rate::from_hz(1.0 / (f.step * seconds));
  column.rows = f.points;
  columns_.push_back(std::move(column));
  functions_.push_back(number);
}

Expected<void> UffReader::open() {
  auto source = open_();
  if (!source) return unexpected(name_ + ": " + source.error().text);
  LineReader lines(**source);
  auto file = read_uff58(lines);
  if (!file) return place_error(name_, file.error());
  found_ = std::move(*file);
  for (std::size_t k = 0; k < found_.functions.size(); ++k) add(found_.functions[k], k);
  if (!columns_.empty()) return {};
  if (leftovers_.empty()) return unexpected(name_ + ": no function (data set 58) in it");
  return unexpected(name_ + ": no function over time in it: '" + leftovers_.front().name + "' " + leftovers_.front().why);
}

Expected<void> UffReader::start(std::span<const std::size_t> selected, std::int64_t first_row) {
  cursors_.clear();
  rows_ = selected.empty() ? 0 : columns_[selected.front()].rows;
  row_ = std::min(first_row, rows_);
  last_read_ = 0;
  for (const std::size_t column : selected) {
    auto source = open_();
    if (!source) return unexpected(name_ + ": " + source.error().text);
    cursors_.emplace_back(std::move(*source), found_.functions[functions_[column]]);
    if (auto done = cursors_.back().values.start(row_); !done) return place_error(name_, done.error());
  }
  return {};
}

Expected<std::size_t> UffReader::read(std::span<double* const> channels, std::size_t count) {
  last_read_ = std::min(static_cast<std::int64_t>(count), rows_ - row_);
  std::size_t c = 0;
  for (Cursor& cursor : cursors_) {
    double* const to = channels[c++];
    for (std::int64_t n = 0; n < last_read_; ++n) {
      const auto value = cursor.values.next();
      if (!value) return place_error(name_, value.error());
      to[n] = *value;
    }
  }
  row_ += last_read_;
  return static_cast<std::size_t>(last_read_);
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_uff(OpenSource open, const std::string& name) {
  auto reader = std::make_unique<UffReader>(std::move(open), name);
  if (auto done = reader->open(); !done) return {Unexpected<Error>{done.error()}};
  return std::unique_ptr<TableReader>(std::move(reader));
}

}  // namespace bodeflow::acquisition
