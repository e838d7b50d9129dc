#include "recording_block.hpp"

#include <cmath>

namespace bodeflow::acquisition {
namespace {

constexpr double kOffGrid = 1e-6;  // of a line: frequencies of a multisine on this grid are multiples to rounding

}  // namespace

void RecordingBlock::describe(Describe& d) {
  d.id("acquisition.recording")
      .summary("Keeps the samples of an experiment and sends them as one record, for methods that need several experiments.")
      .cost_ns(5);
  d.doc(
      "The record holds all samples of both streams, the periods of the transient included, and the lines that the excitation "
      "states. A part of a period at the end is kept, too.");
  d.stream_in(input).doc("what excites the plant");
  d.stream_in(output).doc("what the plant answers, at the same rate");
  d.message_out(out).record_type("recording").doc("the samples, at the end");
  d.parameter("period", std::int64_t{0}).range(0, 1 << 28).doc("samples of a period of the excitation; 0: not periodic");
  d.parameter("skip", std::int64_t{0}).range(0, 1'000'000).doc("periods at the start that hold the transient");
  d.parameter("limit", std::int64_t{16'777'216}).range(16, 1'000'000'000).doc("most samples of a channel; 8 bytes each");
}

void RecordingBlock::configure(const Parameters& p) {
  about_ = {};
  about_.period = p.integer("period");
  about_.skip = p.integer("skip");
  limit_ = p.integer("limit");
  if (about_.period == 0 && about_.skip > 0) fail("skip counts periods: it needs period, the samples of one");
}

void RecordingBlock::resolve(Facts& f) {
  const auto &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  if (u.clock != y.clock) fail("input and output are in different clock domains: " + u.clock + " and " + y.clock);
  about_.sample_rate_hz = u.rate.hz();
  about_.input_signals = records::signals_of(u, "input");
  about_.output_signals = records::signals_of(y, "output");
  take_excitation(u);
  samples_.assign(static_cast<std::size_t>(u.channels + y.channels), {});
}

void RecordingBlock::take_excitation(const StreamFacts& u) {
  about_.excited_lines.clear();
  about_.excited_amplitudes.clear();
  const auto frequencies = u.note("excitation.frequencies"), amplitudes = u.note("excitation.amplitudes");
  if (about_.period == 0 || frequencies.size() != amplitudes.size()) return;
  const double line_hz = about_.sample_rate_hz / static_cast<double>(about_.period);
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double line = frequencies[i] / line_hz;
    if (std::abs(line - std::round(line)) > kOffGrid) {
      about_.excited_lines.clear();
      about_.excited_amplitudes.clear();
      return;
    }
    about_.excited_lines.push_back(static_cast<std::int64_t>(std::round(line)));
    about_.excited_amplitudes.push_back(amplitudes[i]);
  }
}

void RecordingBlock::process(Io& io) {
  const int inputs = static_cast<int>(about_.input_signals.names.size());
  for (std::size_t c = 0; c < samples_.size(); ++c) {
    const int channel = static_cast<int>(c);
    const auto x = channel < inputs ? io.read(input, channel) : io.read(output, channel - inputs);
    if (samples_[c].size() + x.size() > static_cast<std::size_t>(limit_))
      fail("more than " + std::to_string(limit_) + " samples: give a greater limit, or a shorter duration");
    for (std::size_t n = 0; n < x.size(); ++n)
      if (!std::isfinite(x[n])) {
        const bool is_input = channel < inputs;
        const auto& names = is_input ? about_.input_signals.names : about_.output_signals.names;
        fail("'" + names[static_cast<std::size_t>(is_input ? channel : channel - inputs)] + "' is not finite at sample " +
             std::to_string(samples_[c].size() + n));
      }
    samples_[c].insert(samples_[c].end(), x.begin(), x.end());
  }
}

void RecordingBlock::finish(Io& io) {
  const std::int64_t count = samples_.empty() ? 0 : static_cast<std::int64_t>(samples_.front().size());
  if (count == 0) fail("no sample came");
  records::Recording recording = about_;
  if (recording.period > 0) {
    recording.periods = count / recording.period - recording.skip;
    if (recording.periods < 1)
      fail(std::to_string(count) + " samples came; needed: " + std::to_string(recording.skip) + " periods of " +
           std::to_string(recording.period) + " samples to skip, and one more");
  }
  const auto inputs = static_cast<Eigen::Index>(recording.input_signals.names.size());
  const auto channels = static_cast<Eigen::Index>(samples_.size());
  recording.input.resize(count, inputs);
  recording.output.resize(count, channels - inputs);
  for (Eigen::Index c = 0; c < channels; ++c) {
    const auto channel = Eigen::Map<const Eigen::VectorXd>(samples_[static_cast<std::size_t>(c)].data(), count);
    if (c < inputs)
      recording.input.col(c) = channel;
    else
      recording.output.col(c - inputs) = channel;
  }
  io.emit(out, records::write_recording(recording));
}

void RecordingBlock::reset() {
  for (auto& channel : samples_) channel.clear();
}

}  // namespace bodeflow::acquisition
