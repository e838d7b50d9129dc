#include "file_block.hpp"

#include <algorithm>
#include <filesystem>

#include "import_report.hpp"
#include "open_table.hpp"
#include "overlooked_time.hpp"

namespace bodeflow::acquisition {
namespace {

// From this size on it is said that a file is read whole before the run begins.
constexpr std::uintmax_t kLongFile = std::uintmax_t{256} << 20;

}  // namespace

void FileBlock::describe(Describe& d) {
  d.id("acquisition.file").summary("Reads equally sampled signals from a data file.").role("source").cost_ns(200);
  d.doc(
      "CSV, HDF5 (the recordings of runs among them), MATLAB v5 to v7.3, WAV, FLAC and UFF58. The sampling rate comes from the "
      "file where it states one, from a time column, which is checked for equal steps (each time within 10 % of a step of its "
      "place), or from `rate`. The file is read twice in bounded memory: once to check all that is used of it, once to run. "
      "What was found is logged: columns, units, rate, rows, gaps, clipping.");
  d.stream_out(out).doc("the columns named by `columns`; without it all that are read");
  d.stream_out(input).doc("the columns named by `input`; without it those of `out`");
  d.stream_out(output).doc("the columns named by `output`; without it those of `out`");
  d.required<File>("file").doc("the data file: " + table_endings());
  d.optional<double>("rate").unit("Hz").above(0.0).doc(
      "samples per second; needed where the file has no rate and no time column, else checked against them");
  d.parameter("time", "check").choices({"check", "ignore"}).doc("`ignore`: `rate` holds whatever the file says");
  d.optional<std::string>("time_column").doc("the column that holds time, where it is not named t or time");
  d.optional<std::string>("time_unit").doc("the unit of a time column that states none, such as ms");
  d.parameter("start", std::int64_t{0}).range(0, 1e15).doc("rows left out before the first that is used");
  d.optional<std::int64_t>("count").range(1, 1e15).doc("rows used; without it all that follow");
  d.optional<double>("from").unit("s").doc(
      "used are rows from this time on: that of the time column, else from the first row on");
  d.optional<double>("to").unit("s").doc("used are rows before this time");
  d.parameter("columns", std::vector<std::string>{})
      .doc(
          "columns of port `out`, with or without their unit; `path[2]` is the second column of an array; where no column is "
          "named at all, every one but time is read");
  d.parameter("input", std::vector<std::string>{}).doc("columns of port `input`: what excites the plant");
  d.parameter("output", std::vector<std::string>{}).doc("columns of port `output`: what the plant answers");
}

void FileBlock::configure(const Parameters& p) {
  path_ = p.text("file");
  part_ = read_part(p);
  Timing timing;
  if (p.has("rate")) timing.rate_hz = p.number("rate");
  timing.ignore_time_column = p.text("time") == "ignore";
  if (timing.ignore_time_column && !timing.rate_hz) fail("time: ignore needs rate: the samples per second");
  if (p.has("time_column")) timing.time_column = p.text("time_column");
  if (p.has("time_unit")) timing.time_unit = p.text("time_unit");
  if (!timing.time_unit.empty() && !seconds_per(timing.time_unit))
    fail("time_unit: '" + timing.time_unit + "' is no unit of time");
  auto reader = open_table(path_);
  if (!reader) fail(reader.error().text);
  reader_ = std::move(*reader);
  note_input(path_);
  selected_.clear();
  out_channels_ = select(p.texts("columns"), "columns");
  input_channels_ = select(p.texts("input"), "input");
  output_channels_ = select(p.texts("output"), "output");
  if (selected_.empty()) select_all(timing);
  if (out_channels_.empty()) {
    for (std::size_t place = 0; place < selected_.size(); ++place) out_channels_.push_back(place);
  }
  if (input_channels_.empty()) input_channels_ = out_channels_;
  if (output_channels_.empty()) output_channels_ = out_channels_;
  scan(timing);
}

Part FileBlock::read_part(const Parameters& p) const {
  Part part;
  part.start = p.integer("start");
  if (p.has("count")) part.count = p.integer("count");
  if (p.has("from")) part.from_s = p.number("from");
  if (p.has("to")) part.to_s = p.number("to");
  if (part.by_time() && (part.start != 0 || part.count)) fail("start and count go by rows, from and to by time: give one pair");
  if (part.from_s && part.to_s && !(*part.from_s < *part.to_s)) fail("from is not before to");
  return part;
}

void FileBlock::scan(const Timing& timing) {
  const auto time = find_time_column(*reader_, selected_, timing);
  if (!time) fail(time.error().text);
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path_, unknown);
  if (!unknown && size >= kLongFile) log_info(path_ + ": " + std::to_string(size >> 20) + " MiB, being checked before the run");
  auto summary = scan_table(*reader_, selected_, *time, timing, part_);
  if (!summary) fail(summary.error().text);
  summary_ = std::move(*summary);
  const ImportReport report = report_import(*reader_, selected_, *time, summary_);
  log_info(report.found);
  for (const std::string& warning : report.warnings) log_warning(warning);
  if (*time || timing.ignore_time_column) return;
  for (const std::string& warning : overlooked_times(*reader_, selected_, summary_)) log_warning(warning);
}

std::size_t FileBlock::place_of(std::size_t column) {
  const auto found = std::find(selected_.begin(), selected_.end(), column);
  if (found != selected_.end()) return static_cast<std::size_t>(found - selected_.begin());
  selected_.push_back(column);
  return selected_.size() - 1;
}

FileBlock::Channels FileBlock::select(const std::vector<std::string>& names, const char* parameter) {
  Channels channels;
  for (const std::string& name : names) {
    const auto column = find_column(reader_->columns(), name, reader_->leftovers());
    if (!column) fail(path_ + ": " + parameter + ": " + column.error().text);
    const std::size_t place = place_of(*column);
    if (std::find(channels.begin(), channels.end(), place) != channels.end())
      fail(std::string(parameter) + ": column '" + name + "' stands twice");
    channels.push_back(place);
  }
  return channels;
}

void FileBlock::select_all(const Timing& timing) {
  const auto named = find_column(reader_->columns(), timing.time_column);
  for (std::size_t c = 0; c < reader_->columns().size(); ++c) {
    const Column& column = reader_->columns()[c];
    const bool time = is_time(column) || (is_named_time(column) && column.unit.empty() && !timing.time_unit.empty()) ||
                      (!timing.time_column.empty() && named && *named == c);
    if (!time) place_of(c);
  }
  if (selected_.empty()) fail(path_ + ": no column beside the time column");
}

void FileBlock::resolve(Facts& f) {
  state(out, out_channels_, f);
  state(input, input_channels_, f);
  state(output, output_channels_, f);
}

void FileBlock::state(Out<double> port, const Channels& channels, Facts& f) const {
  StreamFacts& facts = f.out(port);
  facts.known = true;
  facts.channels = static_cast<int>(channels.size());
  facts.rate = summary_.rate;
  facts.length = summary_.rows;
  for (const std::size_t place : channels) {
    const Column& column = reader_->columns()[selected_[place]];
    const auto same = [&](const Column& other) { return other.name == column.name; };
    const bool unique = std::count_if(reader_->columns().begin(), reader_->columns().end(), same) == 1;
    facts.channel_names.push_back(unique ? column.name : column.header);
    facts.channel_units.push_back(column.unit);
  }
  const auto& units = facts.channel_units;
  if (std::count(units.begin(), units.end(), units.front()) == static_cast<std::ptrdiff_t>(units.size()))
    facts.unit = units.front();
}

void FileBlock::activate(const Activation& a) {
  rows_.assign(selected_.size(), std::vector<double>(static_cast<std::size_t>(a.max_count)));
  places_.clear();
  for (auto& rows : rows_) places_.push_back(rows.data());
  reset();
}

void FileBlock::reset() {
  done_ = 0;
  if (auto started = reader_->start(selected_, summary_.first_row); !started) fail(started.error().text);
}

void FileBlock::process(Io& io) {
  const std::int64_t left = summary_.rows - done_;
  const auto wanted =
      part_.whole() ? io.count() : static_cast<std::size_t>(std::min<std::int64_t>(left, static_cast<std::int64_t>(io.count())));
  const auto rows = reader_->read(places_, wanted);
  if (!rows) fail(rows.error().text);
  done_ += static_cast<std::int64_t>(*rows);
  if (done_ > summary_.rows || (*rows < io.count() && done_ != summary_.rows)) fail(path_ + ": changed while it was read");
  give(out, out_channels_, *rows, io);
  give(input, input_channels_, *rows, io);
  give(output, output_channels_, *rows, io);
  if (*rows < io.count()) io.end_after(*rows);
}

void FileBlock::give(Out<double> port, const Channels& channels, std::size_t rows, Io& io) const {
  const std::size_t wanted = std::min(channels.size(), static_cast<std::size_t>(io.channels(port)));
  for (std::size_t c = 0; c < wanted; ++c) {
    std::copy_n(rows_[channels[c]].begin(), rows, io.write(port, static_cast<int>(c)).begin());
  }
}

void FileBlock::deactivate() { rows_.clear(); }

}  // namespace bodeflow::acquisition
