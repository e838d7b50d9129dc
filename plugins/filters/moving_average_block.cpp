#include "moving_average_block.hpp"

#include <Eigen/Core>

#include "filter_record.hpp"
#include "notes.hpp"

namespace bodeflow::filters {
namespace {

constexpr std::int64_t kMostSamples = 1 << 20;

}  // namespace

void MovingAverageBlock::describe(Describe& d) {
  d.id("filters.moving_average").summary("The mean of the last samples.").realtime_safe().in_place().cost_ns(2);
  d.doc(
      "y[n] = (x[n] + x[n - 1] + ... + x[n - length + 1]) / length, zeros before the start. It is exactly 0 at the multiples of "
      "the "
      "rate over the length: a length of one period takes that period and its harmonics out. Delay (length - 1) / 2 samples. The "
      "sums are made anew in each window's length, so nothing drifts; at the end of each length of samples the block adds as "
      "many "
      "numbers at once.");
  d.required<std::int64_t>("length").range(1, kMostSamples).doc("samples");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
  d.message_out(filter).record_type("filter").doc("at the end: impulse and frequency response");
}

void MovingAverageBlock::configure(const Parameters& p) {
  length_ = p.integer("length");
  if (length_ < 1 || length_ > kMostSamples) {
    fail("length is " + std::to_string(length_) + "; allowed: 1 to " + std::to_string(kMostSamples));
  }
}

void MovingAverageBlock::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  rate_hz_ = x.rate.hz();
  channels_ = x.channels;
  f.out(out).notes = filtered(x.notes, static_cast<double>(length_) / rate_hz_);
}

void MovingAverageBlock::activate(const Activation&) {
  averages_.assign(static_cast<std::size_t>(channels_), MovingAverage(static_cast<std::size_t>(length_)));
}

void MovingAverageBlock::process(Io& io) {
  for (std::size_t c = 0; c < averages_.size(); ++c) {
    averages_[c].run(io.read(in, static_cast<int>(c)), io.write(out, static_cast<int>(c)));
  }
}

void MovingAverageBlock::finish(Io& io) {
  io.emit(filter, fir_record("moving average", rate_hz_, Eigen::VectorXd::Constant(length_, 1.0 / static_cast<double>(length_))));
}

void MovingAverageBlock::reset() {
  for (MovingAverage& average : averages_) average.reset();
}

}  // namespace bodeflow::filters
