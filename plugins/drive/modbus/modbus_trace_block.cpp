#include "modbus_trace_block.hpp"

#include <algorithm>

#include "connection_parameters.hpp"
#include "register_map_file.hpp"
#include "trace_import.hpp"

namespace bodeflow::drive::modbus {

void ModbusTraceBlock::describe(Describe& d) {
  d.id("drive.modbus_trace").summary("Reads the trace buffer of a drive on Modbus.").role("source").role("device");
  d.doc(
      "The drive has recorded by itself, faster than it can be polled: drive.modbus with arm_trace starts that. The whole buffer "
      "is read before the first sample, so that the clock of the run does not matter. Rate, length, channels and units are those "
      "of the register map's `trace`.");
  d.stream_out(out).doc("one channel a channel of the trace");
  describe_connection(d);
}

void ModbusTraceBlock::configure(const Parameters& p) {
  endpoint_ = read_connection(p);
  auto map = read_register_map(p.text("map"));
  if (!map) fail(map.error().text);
  note_input(p.text("map"));
  map_ = std::move(*map);
  if (!map_.trace) fail(map_.file + " has no 'trace'");
}

void ModbusTraceBlock::resolve(Facts& f) {
  StreamFacts& y = f.out(out);
  y.known = true;
  y.channels = static_cast<int>(map_.trace->channels.size());
  y.rate = Rate::from_hz(map_.trace->rate_hz);
  y.length = map_.trace->samples;
  for (const Register& channel : map_.trace->channels) {
    y.channel_names.push_back(channel.name);
    y.channel_units.push_back(channel.unit);
  }
  const auto& units = y.channel_units;
  if (std::all_of(units.begin(), units.end(), [&](const auto& u) { return u == units.front(); })) y.unit = units.front();
}

void ModbusTraceBlock::activate(const Activation&) {
  auto link = Link::open(endpoint_);
  if (!link) fail(link.error().text);
  auto samples = import_trace(**link, map_);
  if (!samples) fail(samples.error().text);
  samples_ = std::move(*samples);
  done_ = 0;
}

void ModbusTraceBlock::process(Io& io) {
  const auto count = std::min<std::int64_t>(map_.trace->samples - done_, static_cast<std::int64_t>(io.count()));
  for (std::size_t c = 0; c < samples_.size(); ++c) {
    std::copy_n(samples_[c].begin() + done_, count, io.write(out, static_cast<int>(c)).begin());
  }
  done_ += count;
  if (count < static_cast<std::int64_t>(io.count())) io.end_after(static_cast<std::uint64_t>(count));
}

}  // namespace bodeflow::drive::modbus
