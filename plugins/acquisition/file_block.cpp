#include "file_block.hpp"

#include <algorithm>

#include "csv.hpp"
#include "sampling.hpp"
#include "summary.hpp"

namespace bodeflow::acquisition {
namespace {

std::string label(const Column& column) { return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]"; }

}  // namespace

void FileBlock::describe(Describe& d) {
  d.id("acquisition.file").summary("Reads equally sampled signals from a data file.").role("source").cost_ns(200);
  d.doc(
      "CSV with a header `name [unit]` or `name_unit` per column; the sampling rate comes from a time column `t [s]` or `time "
      "[s]`, "
      "which is checked for equal steps (each time within 10 % of a step of its place), or from `rate`. The file is read twice "
      "in "
      "bounded memory: once to check it whole, once to run. What was found is logged: columns, units, rate, rows, gaps, "
      "clipping.");
  d.stream_out(out).doc("the columns named by `columns`; without it all that are read");
  d.stream_out(input).doc("the columns named by `input`; without it those of `out`");
  d.stream_out(output).doc("the columns named by `output`; without it those of `out`");
  d.required<File>("file").doc("the data file: .csv, .txt, .tsv or .dat");
  d.optional<double>("rate").unit("Hz").above(0.0).doc(
      "samples per second; needed without a time column, else checked against it");
  d.parameter("time", "check").choices({"check", "ignore"}).doc("`ignore`: `rate` holds whatever the time column says");
  d.parameter("columns", std::vector<std::string>{})
      .doc("columns of port `out`, with or without their unit; where no column is named at all, every one but time is read");
  d.parameter("input", std::vector<std::string>{}).doc("columns of port `input`: what excites the plant");
  d.parameter("output", std::vector<std::string>{}).doc("columns of port `output`: what the plant answers");
}

void FileBlock::configure(const Parameters& p) {
  path_ = p.text("file");
  auto reader = open_table(path_);
  if (!reader) fail(reader.error().text);
  reader_ = std::move(*reader);
  note_input(path_);
  selected_.clear();
  out_channels_ = select(p.texts("columns"), "columns");
  input_channels_ = select(p.texts("input"), "input");
  output_channels_ = select(p.texts("output"), "output");
  if (selected_.empty()) select_all();
  if (selected_.empty()) fail(path_ + ": no column beside the time column");
  if (out_channels_.empty()) {
    for (std::size_t place = 0; place < selected_.size(); ++place) out_channels_.push_back(place);
  }
  if (input_channels_.empty()) input_channels_ = out_channels_;
  if (output_channels_.empty()) output_channels_ = out_channels_;
  Timing timing;
  if (p.has("rate")) timing.rate_hz = p.number("rate");
  timing.ignore_time_column = p.text("time") == "ignore";
  if (timing.ignore_time_column && !timing.rate_hz) fail("time: ignore needs rate: the samples per second");
  auto summary = reader_->scan(selected_, timing);
  if (!summary) fail(summary.error().text);
  summary_ = std::move(*summary);
  report(timing);
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
    const auto column = find_column(reader_->columns(), name);
    if (!column) fail(path_ + ": " + parameter + ": " + column.error().text);
    const std::size_t place = place_of(*column);
    if (std::find(channels.begin(), channels.end(), place) != channels.end())
      fail(std::string(parameter) + ": column '" + name + "' stands twice");
    channels.push_back(place);
  }
  return channels;
}

void FileBlock::select_all() {
  for (std::size_t c = 0; c < reader_->columns().size(); ++c) {
    if (reader_->time_column() != c) place_of(c);
  }
}

void FileBlock::report(const Timing& timing) const {
  const double rate = summary_.rate.hz();
  std::string text = path_ + ": " + std::to_string(summary_.rows) + " rows at " + number_text(rate) + " Hz (" +
                     short_text(static_cast<double>(summary_.rows) / rate) + " s), ";
  const auto time = reader_->time_column();
  if (time && !timing.ignore_time_column) {
    text += "equally sampled by column '" + reader_->columns()[*time].header + "', no gaps";
  } else {
    text += "rate as stated, gaps can't be seen without a time column";
  }
  for (const std::string& remark : summary_.remarks) text += ", " + remark;
  text += "; read";
  for (std::size_t i = 0; i < selected_.size(); ++i) {
    const ColumnSummary& s = summary_.columns[i];
    text += (i == 0 ? " " : ", ") + label(reader_->columns()[selected_[i]]) + " " + short_text(s.least) + " to " +
            short_text(s.greatest);
  }
  std::string passed;
  for (std::size_t c = 0; c < reader_->columns().size(); ++c) {
    if (time == c || std::find(selected_.begin(), selected_.end(), c) != selected_.end()) continue;
    passed += (passed.empty() ? "; not read " : ", ") + label(reader_->columns()[c]);
  }
  log_info(text + passed);
  for (std::size_t i = 0; i < selected_.size(); ++i) {
    const std::string suspicion = clipping_suspicion(summary_.columns[i]);
    if (!suspicion.empty()) log_warning(path_ + ": column '" + reader_->columns()[selected_[i]].header + "' " + suspicion);
  }
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
  if (auto started = reader_->start(selected_); !started) fail(started.error().text);
}

void FileBlock::process(Io& io) {
  const auto rows = reader_->read(places_, io.count());
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
