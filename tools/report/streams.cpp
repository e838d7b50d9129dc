#include "report/streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::uint64_t kBins = 1000;              ///< of an envelope
constexpr std::uint64_t kWholeUpTo = 2000;         ///< samples that are drawn one by one
constexpr std::uint64_t kPieceValues = 1U << 20U;  ///< read at once
constexpr std::size_t kMostCharts = 24;
constexpr std::uint32_t kMostChannels = 4096;
constexpr std::uint64_t kMostValues = 20'000'000'000;

/// What one channel shows over time, and its figures.
struct ChannelView {
  Series series;
  double sum = 0.0;
  double squares = 0.0;
  std::uint64_t finite = 0;
  Extent extent;
};

std::string channel_name(const record::StoredStream& stream, std::size_t c) {
  const std::string key = record::key_of(stream.origin);
  const std::string own = c < stream.channel_names.size() ? stream.channel_names[c] : "";
  if (stream.channels == 1) return own.empty() || own == stream.origin.port ? key : fmt::format("{} ({})", key, own);
  return fmt::format("{} {}", key, own.empty() ? std::to_string(c + 1) : own);
}

std::string channel_unit(const record::StoredStream& stream, std::size_t c) {
  const std::string own = c < stream.channel_units.size() ? stream.channel_units[c] : "";
  return own.empty() ? stream.unit : own;
}

double rate_of(const record::StoredStream& stream) {
  const double rate = static_cast<double>(stream.rate.num) / static_cast<double>(stream.rate.den);
  return rate > 0.0 ? rate : 1.0;
}

/// Collects the views of all channels of a stream, a piece after the other.
class Collector {
 public:
  explicit Collector(const record::StoredStream& stream)
      : stream_(stream), views_(stream.channels), complex_(stream.element == BF_C64), rate_(rate_of(stream)) {
    bins_ = stream.length <= kWholeUpTo ? 0 : kBins;
    for (auto& view : views_) {
      view.series.envelope = bins_ > 0;
      if (bins_ == 0) continue;
      for (std::uint64_t b = 0; b < bins_; ++b)
        view.series.x.push_back(time_of(first_of(b) + (first_of(b + 1) - first_of(b)) / 2));
      view.series.low.assign(bins_, kNaN);
      view.series.high.assign(bins_, kNaN);
    }
  }

  void take(std::uint64_t first, const std::vector<double>& values) {
    const std::size_t channels = views_.size(), parts = complex_ ? 2 : 1, count = values.size() / (channels * parts);
    for (std::size_t n = 0; n < count; ++n)
      for (std::size_t c = 0; c < channels; ++c) {
        const double* x = values.data() + (n * channels + c) * parts;
        add(views_[c], first + n, complex_ ? std::hypot(x[0], x[1]) : x[0]);
      }
  }

  std::vector<ChannelView> finish() {
    for (auto& view : views_)
      if (bins_ > 0) view.series.y = view.series.high;
    return std::move(views_);
  }

 private:
  std::uint64_t first_of(std::uint64_t bin) const {
    // Without overflow for any length: whole part and rest apart
    return bin * (stream_.length / bins_) + bin * (stream_.length % bins_) / bins_;
  }
  std::uint64_t bin_of(std::uint64_t sample) const {
    auto bin = static_cast<std::uint64_t>(static_cast<double>(sample) / static_cast<double>(stream_.length) *
                                          static_cast<double>(bins_));
    bin = std::min(bin, bins_ - 1);
    while (bin > 0 && sample < first_of(bin)) --bin;
    while (bin + 1 < bins_ && sample >= first_of(bin + 1)) ++bin;
    return bin;
  }
  double time_of(std::uint64_t sample) const {
    return (static_cast<double>(stream_.first_position) + static_cast<double>(sample)) / rate_;
  }

  void add(ChannelView& view, std::uint64_t sample, double x) {
    if (std::isfinite(x)) {
      view.sum += x;
      view.squares += x * x;
      ++view.finite;
    }
    view.extent.add(x);
    if (bins_ == 0) {
      view.series.x.push_back(time_of(sample));
      view.series.y.push_back(std::isfinite(x) ? x : kNaN);
      return;
    }
    if (!std::isfinite(x)) return;
    const std::uint64_t bin = bin_of(sample);
    double& low = view.series.low[bin];
    double& high = view.series.high[bin];
    if (!(low <= x)) low = x;
    if (!(high >= x)) high = x;
  }

  const record::StoredStream& stream_;
  std::vector<ChannelView> views_;
  bool complex_;
  double rate_;
  std::uint64_t bins_ = 0;
};

/// Error: a piece can't be read; what came before it is in the collector.
std::string read_pieces(const record::DataFile& file, const record::StoredStream& stream, Collector& collector,
                        const std::function<void(std::uint64_t)>& read) {
  const std::uint64_t parts = stream.element == BF_C64 ? 2 : 1;
  const std::uint64_t piece = std::max<std::uint64_t>(1, kPieceValues / (std::max<std::uint64_t>(1, stream.channels) * parts));
  for (std::uint64_t first = 0; first < stream.length; first += piece) {
    const std::uint64_t count = std::min(piece, stream.length - first);
    const auto values = file.read(stream, first, count);
    if (!values) return values.error();
    collector.take(first, *values);
    read(count);
  }
  return "";
}

/// Why a stream can't be read as a whole; "" : it can. A damaged or foreign file may name any size.
std::string refusal(const record::StoredStream& stream) {
  if (stream.channels == 0 || stream.channels > kMostChannels) return fmt::format("it has {} channels", stream.channels);
  if (stream.length > kMostValues / stream.channels)
    return fmt::format("{} samples are too many to read", counted(stream.length));
  return "";
}

Chart channel_chart(const record::StoredStream& stream, std::size_t c, ChannelView view) {
  Chart chart;
  chart.title = channel_name(stream, c);
  chart.name = "stream_" + chart.title;
  chart.description = fmt::format("Values over time: {} samples at {} Hz.", stream.length, shown(rate_of(stream), 6));
  chart.x_title = "Time [s]";
  Panel panel;
  panel.y.title = with_unit(stream.element == BF_C64 ? "Magnitude" : "Value", channel_unit(stream, c));
  panel.height = 220.0;
  panel.series.push_back(std::move(view.series));
  chart.panels.push_back(std::move(panel));
  return chart;
}

void add_row(Table& table, const record::StoredStream& stream, std::size_t c, const ChannelView& view) {
  const auto count = static_cast<double>(view.finite);
  const double rms = std::sqrt(view.squares / count);
  table.rows.push_back({channel_name(stream, c), channel_unit(stream, c), shown(rate_of(stream), 6), counted(stream.length),
                        shown(static_cast<double>(stream.length) / rate_of(stream), 5),
                        view.extent.empty() ? "–" : shown(view.extent.low), view.extent.empty() ? "–" : shown(view.extent.high),
                        shown(view.sum / count), shown(rms)});
}

}  // namespace

void add_streams(Page& page, RunData& run, const std::function<void(double)>& progress) {
  if (!run.data || run.data->streams().empty()) return;
  page.open_section("Recorded streams", "data.h5");
  Table table{"Channels",
              {{"Channel", false},
               {"Unit", false},
               {"Rate [Hz]"},
               {"Samples"},
               {"Duration [s]"},
               {"Least"},
               {"Greatest"},
               {"Mean"},
               {"RMS"}},
              {}};
  std::vector<Chart> charts;
  double total = 0.0, done = 0.0;
  for (const auto& stream : run.data->streams()) total += static_cast<double>(stream.length) * stream.channels;
  std::size_t channels = 0;
  for (const auto& stream : run.data->streams()) {
    if (const std::string reason = refusal(stream); !reason.empty()) {
      page.note(record::key_of(stream.origin) + " is left out: " + reason);
      continue;
    }
    Collector collector(stream);
    const std::string error = read_pieces(*run.data, stream, collector, [&](std::uint64_t count) {
      done += static_cast<double>(count) * stream.channels;
      progress(total > 0.0 ? done / total : 1.0);
    });
    if (!error.empty()) page.note(error);
    auto views = collector.finish();
    for (std::size_t c = 0; c < views.size(); ++c, ++channels) {
      add_row(table, stream, c, views[c]);
      if (charts.size() < kMostCharts && stream.length > 0) charts.push_back(channel_chart(stream, c, std::move(views[c])));
    }
  }
  add_table(page.body(), table);
  page.grid(charts,
            "Long streams are drawn as the band between the least and the greatest value of each of 1000 pieces of time.");
  if (channels > charts.size())
    page.note(fmt::format("{} of {} channels are drawn; all stand in data.h5.", charts.size(), channels));
  page.close_section();
}

}  // namespace bodeflow::tools::report
