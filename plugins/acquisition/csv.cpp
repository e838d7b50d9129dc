#include "csv.hpp"

#include <algorithm>
#include <cmath>

#include "csv_header.hpp"
#include "csv_row.hpp"
#include "summary.hpp"

namespace bodeflow::acquisition {
namespace {

class CsvReader final : public TableReader {
 public:
  CsvReader(std::unique_ptr<ByteSource> source, std::string name)
      : source_(std::move(source)), name_(std::move(name)), lines_(*source_) {}

  Expected<void> open();
  const std::string& file() const override { return name_; }
  const std::vector<Column>& columns() const override { return header_.columns; }
  Expected<void> start(std::span<const std::size_t> selected, std::int64_t first_row) override;
  Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) override;
  std::string place(std::size_t n) const override { return name_ + ":" + std::to_string(line_numbers_[n]); }
  double resolution() const override { return std::pow(10.0, last_digit_); }
  std::vector<std::string> remarks() const override;

 private:
  Expected<bool> next_row_line();
  Unexpected<Error> refuse(const TextError& e) const;

  std::unique_ptr<ByteSource> source_;
  std::string name_;
  LineReader lines_;
  Header header_;
  std::optional<RowParser> parser_;
  std::vector<double> values_;              // of the row just read
  std::vector<std::int64_t> line_numbers_;  // of the rows of the last read
  int last_digit_ = kNoDigit;
  std::int64_t comments_ = 0;
  std::int64_t empty_line_ = 0;  // the first empty line since the last row, 0: none
  bool in_rows_ = false;

  static constexpr int kNoDigit = 1000;
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

/// To the next line with a row; false at the end.
Expected<bool> CsvReader::next_row_line() {
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
    return true;
  }
}

Expected<void> CsvReader::start(std::span<const std::size_t> selected, std::int64_t first_row) {
  for (const std::size_t c : selected) {
    if (const auto broken = header_.unreadable.find(c); broken != header_.unreadable.end()) return refuse(broken->second);
  }
  std::vector<int> slots(header_.columns.size(), -1);
  for (std::size_t c = 0; c < selected.size(); ++c) slots[selected[c]] = static_cast<int>(c);
  values_.assign(selected.size(), 0.0);
  std::vector<std::string> names;
  for (const Column& c : header_.columns) names.push_back(c.header);
  parser_.emplace(header_.separator, std::move(names), std::move(slots));
  if (auto done = lines_.go_to(); !done) return refuse(done.error());
  last_digit_ = kNoDigit;
  comments_ = 0;
  empty_line_ = 0;
  in_rows_ = false;
  while (lines_.number() < header_.line) {
    const auto more = lines_.next();
    if (!more) return refuse(more.error());
    if (!*more) return unexpected(name_ + ": changed while it was read");
    if (!lines_.line().empty() && lines_.line().front() == '#') ++comments_;
  }
  for (std::int64_t row = 0; row < first_row; ++row) {
    const auto more = next_row_line();
    if (!more) return {Unexpected<Error>{more.error()}};
    if (!*more) break;
  }
  return {};
}

Expected<std::size_t> CsvReader::read(std::span<double* const> channels, std::size_t count) {
  line_numbers_.clear();
  for (std::size_t n = 0; n < count; ++n) {
    const auto more = next_row_line();
    if (!more) return {Unexpected<Error>{more.error()}};
    if (!*more) return n;
    if (auto done = parser_->parse(lines_.line(), lines_.number(), values_); !done) return refuse(done.error());
    last_digit_ = std::min(last_digit_, last_digit_of(parser_->first_slot_text()));
    line_numbers_.push_back(lines_.number());
    for (std::size_t c = 0; c < channels.size(); ++c) channels[c][n] = values_[c];
  }
  return count;
}

std::vector<std::string> CsvReader::remarks() const {
  std::vector<std::string> all;
  if (comments_ > 0)
    all.push_back(std::to_string(comments_) + (comments_ == 1 ? " comment line" : " comment lines") + " passed over");
  if (parser_ && parser_->decimal_comma()) all.push_back("decimal commas");
  if (parser_ && parser_->trailing_separators()) all.push_back("separators at line ends passed over");
  return all;
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_csv(std::unique_ptr<ByteSource> source, const std::string& name) {
  auto reader = std::make_unique<CsvReader>(std::move(source), name);
  if (auto done = reader->open(); !done) return {Unexpected<Error>{done.error()}};
  return std::unique_ptr<TableReader>(std::move(reader));
}

}  // namespace bodeflow::acquisition
