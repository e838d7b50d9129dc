#include "calibration.hpp"

#include <algorithm>
#include <array>
#include <bodeflow/units.hpp>

#include "acquisition/csv_row.hpp"
#include "acquisition/number_line.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::array<const char*, 4> kColumns{"channel", "gain", "offset", "unit"};
enum Column : std::size_t { kChannel, kGain, kOffset, kUnit };

/// Where each of kColumns stands in a row; -1: nowhere.
struct Heading {
  std::array<int, 4> place{-1, -1, -1, -1};
  std::size_t fields = 0;
  char separator = ',';
};

Expected<Heading, TextError> read_heading(std::string_view line, std::int64_t number) {
  Heading heading;
  heading.separator = find_separator(line);
  const auto fields = split(line, number, heading.separator);
  if (!fields) return {Unexpected<TextError>{fields.error()}};
  heading.fields = fields->size();
  for (std::size_t f = 0; f < fields->size(); ++f) {
    const auto column =
        std::find((*fields)[f].text.empty() ? kColumns.end() : kColumns.begin(), kColumns.end(), (*fields)[f].text);
    if (column == kColumns.end()) continue;
    int& place = heading.place[static_cast<std::size_t>(column - kColumns.begin())];
    if (place >= 0) return refused_at(number, (*fields)[f].column, "column '" + (*fields)[f].text + "' stands twice");
    place = static_cast<int>(f);
  }
  for (const Column needed : {kChannel, kGain}) {
    if (heading.place[needed] < 0)
      return refused_at(number, 1,
                        std::string("no column '") + kColumns[needed] + "'; the header names channel, gain, offset, unit");
  }
  return heading;
}

Expected<CalibrationRow, TextError> read_row(const Heading& heading, std::string_view line, std::int64_t number) {
  const auto fields = split(line, number, heading.separator);
  if (!fields) return {Unexpected<TextError>{fields.error()}};
  if (fields->size() != heading.fields)
    return refused_at(number, 1, counted(fields->size(), "field") + "; the header has " + std::to_string(heading.fields));
  const auto field = [&](Column column) -> const Field* {
    const int place = heading.place[column];
    return place < 0 ? nullptr : &(*fields)[static_cast<std::size_t>(place)];
  };
  CalibrationRow row;
  row.channel = field(kChannel)->text;
  if (row.channel.empty()) return refused_at(number, field(kChannel)->column, "a row without the name of its channel");
  for (const auto& [column, value] : {std::pair{kGain, &row.scale.gain}, {kOffset, &row.scale.offset}}) {
    const Field* f = field(column);
    if (f == nullptr || (column == kOffset && f->text.empty())) continue;
    const auto read = number_of(f->text);
    if (!read) return refused_at(number, f->column, std::string("column '") + kColumns[column] + "': " + read.error().text);
    *value = *read;
  }
  if (row.scale.gain == 0.0) return refused_at(number, field(kGain)->column, "a gain of 0; allowed: any other number");
  if (const Field* f = field(kUnit); f != nullptr) {
    if (!is_known_unit(f->text)) return refused_at(number, f->column, shown(f->text) + " is not a unit");
    row.scale.unit = f->text;
  }
  return row;
}

bool is_passed_over(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.empty() || text.front() == '#';
}

}  // namespace

Expected<std::vector<CalibrationRow>, TextError> read_calibration(ByteSource& source) {
  LineReader lines(source);
  std::optional<Heading> heading;
  std::vector<CalibrationRow> rows;
  while (true) {
    const auto more = lines.next();
    if (!more) return {Unexpected<TextError>{more.error()}};
    if (!*more) break;
    if (is_passed_over(lines.line())) continue;
    if (!heading) {
      auto read = read_heading(lines.line(), lines.number());
      if (!read) return {Unexpected<TextError>{read.error()}};
      heading = *read;
      continue;
    }
    auto row = read_row(*heading, lines.line(), lines.number());
    if (!row) return {Unexpected<TextError>{row.error()}};
    const auto same = [&](const CalibrationRow& other) { return other.channel == row->channel; };
    if (std::any_of(rows.begin(), rows.end(), same))
      return refused_at(lines.number(), 1, "channel " + shown(row->channel) + " stands twice");
    rows.push_back(std::move(*row));
  }
  if (rows.empty())
    return refused_at(0, 0, heading ? "no channel below the header" : "empty; needed: a header and a row for each channel");
  return rows;
}

Expected<std::vector<ChannelScale>> scales_of(const std::vector<CalibrationRow>& rows, const std::vector<std::string>& channels) {
  std::vector<ChannelScale> scales;
  for (const std::string& channel : channels) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const CalibrationRow& r) { return r.channel == channel; });
    if (row == rows.end()) {
      std::string known;
      for (const CalibrationRow& r : rows) known += (known.empty() ? "" : ", ") + printable(r.channel);
      return unexpected("no row for channel '" + channel + "'; it has " + known);
    }
    scales.push_back(row->scale);
  }
  return scales;
}

}  // namespace bodeflow::acquisition
