#include "csv.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "csv_header.hpp"
#include "csv_row.hpp"
#include "sampling.hpp"
#include "summary.hpp"

namespace bodeflow::acquisition {
namespace {

class CsvReader final : public TableReader {
 public:
  CsvReader(std::unique_ptr<ByteSource> source, std::string name)
      : source_(std::move(source)), name_(std::move(name)), lines_(*source_) {}

  Expected<void> open();
  const std::vector<Column>& columns() const override { return header_.columns; }
  std::optional<std::size_t> time_column() const override { return header_.time; }
  Expected<TableSummary> scan(std::span<const std::size_t> selected, const Timing& timing) override;
  Expected<void> start(std::span<const std::size_t> selected) override;
  Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) override;

 private:
  Expected<void> go_to_rows(std::span<const std::size_t> selected, bool with_time);
  Expected<bool> next_row();
  Expected<TableSummary> summarise(const Sampling& times, const SummaryOfColumns& values, std::int64_t rows,
                                   const Timing& timing);
  Unexpected<Error> refuse(const TextError& e) const;

  std::unique_ptr<ByteSource> source_;
  std::string name_;
  LineReader lines_;
  Header header_;
  std::optional<RowParser> parser_;
  std::vector<double> values_;   // of the row just read; time first where it is read
  std::size_t first_value_ = 0;  // 1 where time is read
  std::int64_t comments_ = 0;
  std::int64_t empty_line_ = 0;  // the first empty line since the last row, 0: none
  bool in_rows_ = false;
};

Unexpected<Error> CsvReader::refuse(const TextError& e) const {
  std::string text = name_;
  if (e.line > 0) text += ":" + std::to_string(e.line);
  if (e.column > 0) text += ":" + std::to_string(e.column);
  return unexpected(text + ": " + e.text);
}

Expected<void> CsvReader::open() {
  auto header = read_header(lines_);
  if (!header) return refuse(header.error());
  header_ = std::move(*header);
  return {};
}

/// To the first row, with a parser for the selected columns.
Expected<void> CsvReader::go_to_rows(std::span<const std::size_t> selected, bool with_time) {
  std::vector<int> slots(header_.columns.size(), -1);
  first_value_ = with_time ? 1 : 0;
  if (with_time) slots[*header_.time] = 0;
  for (std::size_t c = 0; c < selected.size(); ++c) {
    if (selected[c] >= slots.size() || slots[selected[c]] >= 0)
      return unexpected(name_ + ": a column is selected twice, or is none");
    slots[selected[c]] = static_cast<int>(c + first_value_);
  }
  values_.assign(selected.size() + first_value_, 0.0);
  std::vector<std::string> names;
  for (const Column& c : header_.columns) names.push_back(c.header);
  parser_.emplace(header_.separator, std::move(names), std::move(slots));
  if (auto done = lines_.rewind(); !done) return refuse(done.error());
  comments_ = 0;
  empty_line_ = 0;
  in_rows_ = false;
  while (lines_.number() < header_.line) {
    const auto more = lines_.next();
    if (!more) return refuse(more.error());
    if (!*more) return unexpected(name_ + ": changed while it was read");
    if (!lines_.line().empty() && lines_.line().front() == '#') ++comments_;
  }
  return {};
}

/// The next row in `values_`; false at the end.
Expected<bool> CsvReader::next_row() {
  while (true) {
    const auto more = lines_.next();
    if (!more) return refuse(more.error());
    if (!*more) return false;
    const std::string_view line = lines_.line();
    if (!line.empty() && line.front() == '#') {
      ++comments_;
      continue;
    }
    if (is_empty(line)) {
      if (in_rows_ && empty_line_ == 0) empty_line_ = lines_.number();
      continue;
    }
    if (empty_line_ != 0) return refuse({empty_line_, 1, "empty line between rows: is a sample lost here?"});
    in_rows_ = true;
    if (auto done = parser_->parse(line, lines_.number(), values_); !done) return refuse(done.error());
    return true;
  }
}

Expected<TableSummary> CsvReader::scan(std::span<const std::size_t> selected, const Timing& timing) {
  const bool with_time = header_.time && !timing.ignore_time_column;
  if (!with_time && !timing.rate_hz) {
    return unexpected(name_ + ":" + std::to_string(header_.line) + ": no time column (`t [s]` or `time [s]`)" +
                      (header_.time ? " that is used" : "") + "; give the sampling rate, such as rate: 2500 Hz");
  }
  if (auto done = go_to_rows(selected, with_time); !done) return {Unexpected<Error>{done.error()}};
  Sampling times;
  SummaryOfColumns values(selected.size());
  const double seconds = with_time ? *seconds_per(header_.columns[*header_.time].unit) : 1.0;
  std::int64_t rows = 0;
  while (true) {
    const auto more = next_row();
    if (!more) return {Unexpected<Error>{more.error()}};
    if (!*more) break;
    ++rows;
    if (with_time) {
      const double resolution = resolution_of(parser_->first_slot_text()) * seconds;
      if (const auto wrong = times.add(values_[0] * seconds, resolution)) return refuse({lines_.number(), 0, *wrong});
    }
    values.add(std::span<const double>(values_).subspan(first_value_));
  }
  return summarise(times, values, rows, timing);
}

Expected<TableSummary> CsvReader::summarise(const Sampling& times, const SummaryOfColumns& values, std::int64_t rows,
                                            const Timing& timing) {
  if (rows == 0) return refuse({header_.line, 0, "no rows follow the header"});
  TableSummary s;
  s.rows = rows;
  s.rate_from_time = !timing.rate_hz;
  s.rate = timing.rate_hz ? Rate::from_hz(*timing.rate_hz) : times.rate();
  if (!s.rate.known()) {
    return refuse({0, 0,
                   timing.rate_hz ? "a rate of " + number_text(*timing.rate_hz) + " Hz is beyond what can be kept"
                                  : "one row, so the time column gives no sampling rate"});
  }
  if (timing.rate_hz && !times.agrees_with(*timing.rate_hz)) {
    return refuse({0, 0,
                   "the time column says " + number_text(times.rate().hz()) + " Hz, parameter rate says " +
                       number_text(*timing.rate_hz) + " Hz; time: ignore reads the file by the rate alone"});
  }
  s.columns = values.columns();
  if (comments_ > 0)
    s.remarks.push_back(std::to_string(comments_) + (comments_ == 1 ? " comment line" : " comment lines") + " passed over");
  if (parser_->decimal_comma()) s.remarks.push_back("decimal commas");
  if (parser_->trailing_separators()) s.remarks.push_back("separators at line ends passed over");
  return s;
}

Expected<void> CsvReader::start(std::span<const std::size_t> selected) { return go_to_rows(selected, false); }

Expected<std::size_t> CsvReader::read(std::span<double* const> channels, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) {
    const auto more = next_row();
    if (!more) return {Unexpected<Error>{more.error()}};
    if (!*more) return n;
    for (std::size_t c = 0; c < channels.size(); ++c) channels[c][n] = values_[c];
  }
  return count;
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_csv(std::unique_ptr<ByteSource> source, const std::string& name) {
  auto reader = std::make_unique<CsvReader>(std::move(source), name);
  if (auto done = reader->open(); !done) return {Unexpected<Error>{done.error()}};
  return std::unique_ptr<TableReader>(std::move(reader));
}

Expected<std::unique_ptr<TableReader>> open_table(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (ending != ".csv" && ending != ".txt" && ending != ".tsv" && ending != ".dat") {
    return unexpected(path + ": ending '" + ending + "'; read are .csv, .txt, .tsv, .dat");
  }
  auto source = open_file(path);
  if (!source) return unexpected(path + ": " + source.error().text);
  return open_csv(std::move(*source), path);
}

}  // namespace bodeflow::acquisition
