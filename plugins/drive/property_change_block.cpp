#include "property_change_block.hpp"

#include <cmath>

namespace bodeflow::drive {

void PropertyChange::describe(Describe& d) {
  d.id("drive.property_change")
      .summary("Changes a bench's properties at a stated time: a motor whose leakage saturates, a rotor that warms up.")
      .cost_ns(1);
  d.doc(
      "One record `bench_properties` with the names and values, before the first sample at or after `time` on the clock of the "
      "stream at `clock`. drive.induction_motor goes on with its currents, speed and position.");
  d.required<std::vector<std::string>>("names").doc("of the properties, such as ls, lr, lm");
  d.required<std::vector<double>>("values").doc("of them, in the units of the properties");
  d.required<double>("time").unit("s").range(0, 1e9).doc("of the change");
  d.stream_in(clock).doc("any stream: it gives the time");
  d.message_out(out).record_type("bench_properties");
}

void PropertyChange::configure(const Parameters& p) {
  names_ = p.texts("names");
  values_ = p.numbers("values");
  if (names_.size() != values_.size()) {
    fail(std::to_string(names_.size()) + " names and " + std::to_string(values_.size()) + " values; allowed: as many");
  }
  time_s_ = p.number("time");
}

void PropertyChange::activate(const Activation& a) { at_ = static_cast<std::uint64_t>(std::ceil(time_s_ * a.rate.hz() - 1e-9)); }

void PropertyChange::process(Io& io) {
  if (at_ < io.position() || at_ >= io.position() + io.count()) return;
  RecordBuilder r("bench_properties");
  for (std::size_t i = 0; i < names_.size(); ++i) r.set(names_[i], values_[i]);
  io.emit(out, r, at_ - io.position());
}

}  // namespace bodeflow::drive
