#include "command_buffer_block.hpp"

#include <cmath>

#include "records/signals.hpp"
#include "sensor_stream.hpp"

namespace bodeflow::drive {

void CommandBuffer::describe(Describe& d) {
  d.id("drive.command_buffer")
      .summary("Holds commands back by a buffer and sends them earlier by a lead: a known delay of the drive is made up for.")
      .realtime_safe()
      .in_place()
      .cost_ns(4);
  d.doc(
      "The command is held between its samples and comes later by samples / rate - lead. A lead that is no whole number of "
      "samples "
      "gives each sample the mean of the command over it, as an inverter gives it. With a lead of 0 the command comes out as it "
      "is, `samples` later.");
  d.required<std::int64_t>("samples").range(1, 1 << 20).doc("size of the buffer: the largest lead");
  d.parameter("lead", 0.0).unit("s").range(0, 1e6).live().doc("at most samples / rate");
  d.stream_in(in).doc("commands");
  d.stream_out(out).same_as(in).doc("the commands, later by the buffer and earlier by the lead");
}

void CommandBuffer::configure(const Parameters& p) {
  samples_ = static_cast<std::size_t>(p.integer("samples"));
  change(p);
}

void CommandBuffer::change(const Parameters& p) { lead_s_ = p.number("lead"); }

void CommandBuffer::resolve(Facts& f) {
  if (!f.in(in).known) return;
  rate_hz_ = f.in(in).rate.hz();
  past_.assign(static_cast<std::size_t>(f.in(in).channels), std::vector<double>(samples_ + 2));
}

void CommandBuffer::activate(const Activation&) { reset(); }

void CommandBuffer::process(Io& io) {
  const double later = static_cast<double>(samples_) - lead_s_ * rate_hz_;
  if (later < 0) {
    fail("lead = " + records::short_number(lead_s_) + " s, allowed: at most the buffer's " +
         records::short_number(static_cast<double>(samples_) / rate_hz_) + " s");
  }
  const auto whole = static_cast<std::size_t>(later);
  const double part = later - static_cast<double>(whole);
  std::size_t at = newest_;
  for (std::size_t c = 0; c < past_.size(); ++c) {
    const auto x = io.read(in, static_cast<int>(c));
    const auto y = io.write(out, static_cast<int>(c));
    check_finite(x, static_cast<int>(c), io.position());
    std::vector<double>& past = past_[c];
    const std::size_t size = past.size();
    at = newest_;
    for (std::size_t n = 0; n < x.size(); ++n) {
      at = at + 1 == size ? 0 : at + 1;
      past[at] = x[n];
      const double later_one = past[(at + size - whole) % size], earlier = past[(at + 2 * size - whole - 1) % size];
      y[n] = part == 0 ? later_one : (1 - part) * later_one + part * earlier;
    }
  }
  newest_ = at;
}

void CommandBuffer::reset() {
  for (std::vector<double>& past : past_) std::fill(past.begin(), past.end(), 0.0);
  newest_ = 0;
}

}  // namespace bodeflow::drive
