#include "section_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "filter_record.hpp"
#include "notes.hpp"
#include "records/signals.hpp"

namespace bodeflow::filters {
namespace {

using records::short_number;
using std::numbers::pi;

// Of the record of a large bank.
constexpr std::size_t kMostSamples = 65536;
constexpr std::size_t kMostPoints = 30000;
constexpr std::size_t kFewFilters = 16;  // that get more points around their poles

constexpr double kSlowest = 1 - 1e-12;  // radius of a pole whose settling time is still told

double largest_radius(const std::vector<BankFilter>& filters) {
  double radius = 0;
  for (const BankFilter& f : filters) {
    for (const auto pole : f.poles()) radius = std::max(radius, std::abs(pole));
  }
  return std::min(radius, kSlowest);
}

/// Samples until what is left of a transient is e^-5.
double settling_samples(const std::vector<BankFilter>& filters) {
  const double radius = largest_radius(filters);
  return radius > 0 ? -5 / std::log(radius) : 0;
}

/// `all`: filters in the record, which share its room.
FilterCurve curve_of(const BankFilter& f, double rate_hz, std::size_t all) {
  FilterCurve curve;
  curve.label = f.label;
  curve.response = [&f, rate_hz](double hz) { return f.response(2 * pi * hz / rate_hz); };
  curve.impulse = settled(f.impulse_response(std::clamp<std::size_t>(kMostSamples / all, 16, kMostImpulse)));
  if (all > kFewFilters) return curve;
  for (const auto pole : f.poles()) {
    const double to_hz = rate_hz / (2 * pi);
    if (pole.imag() > 0) curve.resonances.emplace_back(std::arg(pole) * to_hz, (1 - std::abs(pole)) * to_hz);
  }
  return curve;
}

}  // namespace

void require_below_nyquist(const std::string& parameter, double frequency_hz, double rate_hz) {
  if (frequency_hz > 0 && frequency_hz < 0.5 * rate_hz) return;
  fail(parameter + ": " + short_number(frequency_hz) + " Hz; allowed: above 0 and below the Nyquist frequency " +
       short_number(0.5 * rate_hz) + " Hz of 'in'");
}

void SectionBlock::describe_ports(Describe& d) {
  d.realtime_safe().in_place();
  d.stream_in(in);
  d.stream_out(out).same_as(in);
  d.message_out(filter).record_type("filter").doc("at the end: impulse and frequency response");
}

void SectionBlock::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  rate_hz_ = x.rate.hz();
  channels_ = static_cast<std::size_t>(x.channels);
  filters_ = design(rate_hz_);
  StreamFacts& y = f.out(out);
  name_outputs(x, y);
  y.notes = filtered(x.notes, settling_samples(filters_) / rate_hz_);
}

void SectionBlock::name_outputs(const StreamFacts& x, StreamFacts& y) const {
  if (filters_.size() == 1) return;
  const records::Signals signals = records::signals_of(x, "in");
  y.channels = x.channels * static_cast<int>(filters_.size());
  y.channel_names.clear();
  y.channel_units.clear();
  for (std::size_t c = 0; c < channels_; ++c) {
    for (const BankFilter& one : filters_) {
      y.channel_names.push_back(x.channel_names.empty() && channels_ == 1 ? one.label : signals.names[c] + " " + one.label);
      if (!x.channel_units.empty()) y.channel_units.push_back(signals.units[c]);
    }
  }
}

void SectionBlock::advise(const Facts& f, Advice& a) {
  if (!f.in(in).known) return;
  const double samples = settling_samples(filters_);
  a.tell(kind() + ": a transient is below e^-5 after " + short_number(std::ceil(samples), 4) + " samples (" +
         short_number(samples / rate_hz_, 3) + " s)");
}

void SectionBlock::activate(const Activation& a) {
  vector_level_ = a.vector_level;
  bank_.emplace(filters_, channels_);
  x_.resize(channels_);
  y_.resize(bank_->outputs());
}

void SectionBlock::process(Io& io) {
  for (std::size_t c = 0; c < x_.size(); ++c) x_[c] = io.read(in, static_cast<int>(c)).data();
  for (std::size_t c = 0; c < y_.size(); ++c) y_[c] = io.write(out, static_cast<int>(c)).data();
  const auto lost = bank_->run(x_.data(), y_.data(), io.count(), vector_level_);
  if (!lost) return;
  fail("channel " + std::to_string(*lost + 1) + " of 'in': the filter's state is not finite before sample " +
       std::to_string(io.position() + io.count()) + "; allowed are finite samples");
}

void SectionBlock::finish(Io& io) {
  std::vector<FilterCurve> curves;
  for (const BankFilter& one : filters_) curves.push_back(curve_of(one, rate_hz_, filters_.size()));
  const std::size_t points = std::clamp<std::size_t>(kMostPoints / filters_.size(), 16, 300);
  io.emit(filter, filter_record(kind(), rate_hz_, curves, static_cast<int>(points)));
}

void SectionBlock::reset() { bank_->reset(); }

}  // namespace bodeflow::filters
