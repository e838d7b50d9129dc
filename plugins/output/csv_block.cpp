#include "csv_block.hpp"

#include "file_name.hpp"

namespace bodeflow::output {
namespace {

constexpr In<Any> kInputs[] = {CsvBlock::in, CsvBlock::in_2, CsvBlock::in_3, CsvBlock::in_4};

/// The signals of one input: its channel names, or the port's name with the channel's number.
void add_signals(const StreamFacts& facts, const char* port, std::vector<Signal>& signals) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(facts.channels); ++c) {
    Signal s;
    s.complex = facts.element == BF_C64;
    if (c < facts.channel_names.size()) s.name = facts.channel_names[c];
    if (s.name.empty()) s.name = facts.channels == 1 ? port : std::string(port) + "_" + std::to_string(c + 1);
    s.unit = c < facts.channel_units.size() && !facts.channel_units[c].empty() ? facts.channel_units[c] : facts.unit;
    signals.push_back(std::move(s));
  }
}

/// One channel of one input during a call.
struct Source {
  std::span<const double> real;
  std::span<const std::complex<double>> complex;
};

}  // namespace

void CsvBlock::describe(Describe& d) {
  d.id("output.csv").summary("Writes streams to a CSV file in the run directory.").role("sink").cost_ns(100);
  d.doc(
      "A header line `name [unit]`, then one line per sample with the shortest digits that read back as the same value. A "
      "complex "
      "channel takes two columns, re(name) and im(name). acquisition.file reads the file again, bit for bit.");
  d.stream_in(in).doc("the first columns, one per channel");
  d.stream_in(in_2).optional().doc("more columns, of the same sample rate");
  d.stream_in(in_3).optional().doc("more columns");
  d.stream_in(in_4).optional().doc("more columns");
  d.parameter("file", "signals.csv").doc("the file's name, inside the run directory");
  d.parameter("time", true).doc("begin with a column `t [s]`");
  d.parameter("columns", std::vector<std::string>{})
      .doc("names of the columns, one per channel; default: the names of the channels. The unit is added by the block");
}

void CsvBlock::configure(const Parameters& p) {
  name_ = checked_file_name(p.text("file"));
  time_ = p.boolean("time");
  columns_ = p.texts("columns");
}

void CsvBlock::resolve(Facts& f) {
  std::vector<Signal> signals;
  for (const In<Any> port : kInputs) {
    if (f.in(port).known) add_signals(f.in(port), port.name, signals);
  }
  if (!f.in(in).known) return;
  if (time_ && !f.in(in).rate.known()) fail("input 'in' has no sample rate, so there is no time column; give time: false");
  if (!columns_.empty()) {
    if (columns_.size() != signals.size()) {
      fail("columns names " + std::to_string(columns_.size()) + " columns; the inputs have " + std::to_string(signals.size()));
    }
    for (std::size_t i = 0; i < signals.size(); ++i) signals[i].name = columns_[i];
  }
  rate_ = f.in(in).rate;
  headers_ = headers(signals, time_);
}

void CsvBlock::activate(const Activation&) {
  const auto path = output_path(name_);
  if (!path) fail("no run directory to write '" + name_ + "' in");
  path_ = *path;
  reset();
}

void CsvBlock::reset() {
  file_.reset();
  auto made = TextFile::create(path_);
  if (!made) fail(made.error().text);
  file_.emplace(std::move(*made));
  write(csv_line(headers_));
}

void CsvBlock::write(std::string_view text) {
  if (auto done = file_->write(text); !done) fail(done.error().text);
}

void CsvBlock::process(Io& io) {
  std::vector<Source> sources;
  for (const In<Any> port : kInputs) {
    for (int c = 0; c < io.channels(port); ++c) {
      Source s;
      if (io.element(port) == BF_C64) {
        s.complex = io.read<std::complex<double>>(port, c);
      } else {
        s.real = io.read<double>(port, c);
      }
      sources.push_back(s);
    }
  }
  rows_.clear();
  for (std::size_t n = 0; n < io.count(); ++n) {
    const std::size_t begin = rows_.size();
    const auto add = [&](double value) {
      if (rows_.size() != begin) rows_ += ',';
      append_number(rows_, value);
    };
    // One rounding each in product and quotient: the product is exact below 2^53.
    if (time_)
      append_decimal(rows_,
                     static_cast<double>(io.position() + n) * static_cast<double>(rate_.den) / static_cast<double>(rate_.num));
    for (const Source& s : sources) {
      if (s.complex.empty()) {
        add(s.real[n]);
      } else {
        add(s.complex[n].real());
        add(s.complex[n].imag());
      }
    }
    rows_ += '\n';
  }
  write(rows_);
}

void CsvBlock::finish(Io&) {
  if (auto done = file_->close(); !done) fail(done.error().text);
}

void CsvBlock::deactivate() {
  if (!file_) return;
  // After an error of the run what was written so far is kept; a disk that fails here too has nobody left to tell.
  static_cast<void>(file_->close().has_value());
  file_.reset();
}

}  // namespace bodeflow::output
