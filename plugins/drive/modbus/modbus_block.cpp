#include "modbus_block.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>
#include <bodeflow/words.hpp>
#include <cmath>
#include <numeric>

#include "connection_parameters.hpp"
#include "line_time.hpp"
#include "records/signals.hpp"
#include "register_map_file.hpp"
#include "register_value.hpp"

namespace bodeflow::drive::modbus {
namespace {

using records::short_number;

constexpr double kFewestPeriods = 3.0;  // of polling in the drive's watchdog: one cycle may be late without a stop
constexpr double kMuchLate = 0.01;      // share of samples from which on it is worth a warning

bool is_limited(const Register& r) { return std::isfinite(r.minimum); }

std::string limits_of(const Register& r) {
  return "'" + r.name + "' has the limits " + short_number(r.minimum) + " to " + quantity(r.maximum, r);
}

DriveCommand command_of(const std::string& word) {
  if (word == "enable") return DriveCommand::enable;
  return word == "disable" ? DriveCommand::disable : DriveCommand::quick_stop;
}

}  // namespace

void ModbusBlock::describe(Describe& d) {
  d.id("drive.modbus")
      .summary("Runs a drive on Modbus TCP or RTU: set points, measurements, states after CiA 402.")
      .role("device")
      .role("actuator");
  d.doc(
      "Needs `run: {clock: realtime, chunk: 1}`. Each sample starts one cycle on a thread of its own: controlword and set points "
      "are written, statusword and measurements are read. A sample of `measurements` is what the cycle before read, a set point "
      "is written a sample after it was computed: a loop through the drive has two periods of delay, and a drive that answers "
      "late costs old values (counted), not the loop's time. The drive's own communication watchdog is programmed and read back "
      "before each enabling. At the end, on an error and on a violated limit the drive gets a quick stop and its output stage is "
      "switched off; where the program or the line dies, the watchdog stops it. Set points are their safe values until operation "
      "is enabled.");
  d.reference("Modbus Application Protocol V1.1b3, 2012");
  d.reference("IEC 61800-7-201: CiA 402 device profile for drives");
  d.stream_in(set_points).optional().doc("one channel a set point, in the order of parameter `set_points`");
  d.stream_out(measurements).doc("one channel a register of parameter `measurements`");
  d.stream_out(feedback).doc("those of them that parameter `feedback` names: for a loop");
  d.stream_out(status).doc(
      "state (0 not_ready_to_switch_on, 1 switch_on_disabled, 2 ready_to_switch_on, 3 switched_on, 4 operation_enabled, 5 "
      "quick_stop_active, 6 fault_reaction_active, 7 fault), enabled (0 or 1), fault_code, statusword, late (samples so far)");
  d.message_out(report).record_type("drive_report").doc("at the end: cycles, late samples, questions asked again, times");
  describe_connection(d);
  d.required<double>("poll_rate")
      .unit("Hz")
      .range(1e-3, 10e3)
      .doc("cycles a second, the rate of all streams here; at most that of the register map");
  d.parameter("set_points", std::vector<std::string>{}).doc("registers that the stream writes");
  d.parameter("measurements", std::vector<std::string>{}).doc("registers that are read; without it all that can be read");
  d.parameter("feedback", std::vector<std::string>{}).doc("those of measurements that port `feedback` has; without it all");
  d.parameter("drives", true).doc("false: nothing is ever written, the drive is only looked at");
  d.parameter("command", "enable").choices({"enable", "disable", "quick_stop"}).live().doc("what the drive is to do");
  d.parameter("reset_faults", false)
      .doc("a fault that is there before the drive is enabled is reset; without it, and for any later fault, the run ends");
  d.parameter("watchdog", 0.5)
      .unit("s")
      .range(0.001, 60)
      .doc("the drive's own: it stops when it hears nothing for so long; at least three periods of polling");
  d.parameter("enable_time", 3.0).unit("s").range(0.01, 600).doc("longest way to operation_enabled");
  d.parameter("stop_time", 3.0).unit("s").range(0.01, 600).doc("longest way from quick stop to a standstill");
  d.parameter("arm_trace", false).doc("starts the drive's trace buffer once operation is enabled; drive.modbus_trace reads it");
}

void ModbusBlock::configure(const Parameters& p) {
  setup_.endpoint = read_connection(p);
  auto map = read_register_map(p.text("map"));
  if (!map) fail(map.error().text);
  note_input(p.text("map"));
  setup_.map = std::move(*map);
  poll_hz_ = p.number("poll_rate");
  setup_.drives = p.boolean("drives");
  setup_.reset_faults = p.boolean("reset_faults");
  setup_.arm_trace = p.boolean("arm_trace");
  setup_.watchdog_s = p.number("watchdog");
  setup_.enable_time_s = p.number("enable_time");
  setup_.stop_time_s = p.number("stop_time");
  setup_.set_points = select(p.texts("set_points"), "set_points", true);
  setup_.measurements =
      select(p.given("measurements") ? p.texts("measurements") : setup_.map.names(false), "measurements", false);
  if (setup_.measurements.empty()) fail("measurements is empty, allowed: at least one register");
  select_feedback(p.texts("feedback"));
  check_map();
  check_line();
  change(p);
}

void ModbusBlock::select_feedback(const std::vector<std::string>& names) {
  feedback_.clear();
  std::vector<std::string> allowed;
  for (const std::size_t place : setup_.measurements) allowed.push_back(setup_.map.registers[place].name);
  for (const std::string& name : names.empty() ? allowed : names) {
    const auto found = std::find(allowed.begin(), allowed.end(), name);
    if (found == allowed.end()) {
      fail("feedback: '" + name + "' is none of the measurements" + bodeflow::detail::meant(name, allowed) +
           ", allowed: " + bodeflow::detail::listed(allowed));
    }
    feedback_.push_back(static_cast<std::size_t>(found - allowed.begin()));
  }
}

std::vector<std::size_t> ModbusBlock::select(const std::vector<std::string>& names, const char* parameter, bool writable) const {
  std::vector<std::size_t> places;
  std::vector<std::string> allowed;
  for (const std::string& name : setup_.map.names(writable)) {
    if (!writable || (name != kControlword && name != kWatchdog)) allowed.push_back(name);  // the block itself writes these two
  }
  for (const std::string& name : names) {
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
      fail(std::string(parameter) + ": '" + name + "' is no register that can be " + (writable ? "written" : "read") +
           bodeflow::detail::meant(name, allowed) + ", allowed: " + bodeflow::detail::listed(allowed));
    }
    const std::size_t place = setup_.map.find(name).value();
    if (std::find(places.begin(), places.end(), place) != places.end()) {
      fail(std::string(parameter) + ": '" + name + "' stands twice");
    }
    places.push_back(place);
  }
  return places;
}

void ModbusBlock::check_map() const {
  const RegisterMap& map = setup_.map;
  if (poll_hz_ > map.fastest_poll_hz) {
    fail("poll_rate is " + short_number(poll_hz_) + " Hz, allowed by " + map.file + ": at most " +
         short_number(map.fastest_poll_hz) + " Hz");
  }
  if (!setup_.drives) {
    if (!setup_.set_points.empty()) fail("drives: false takes no set_points");
    return;
  }
  if (!map.find(kWatchdog)) {
    fail(map.file + " has no register 'watchdog': the drive would run on when this program ends; allowed: drives: false");
  }
  check_watchdog(map.registers[*map.find(kWatchdog)]);
  if (setup_.arm_trace && !(map.trace && map.trace->arm)) fail("arm_trace: " + map.file + " has no trace with 'arm'");
}

void ModbusBlock::check_watchdog(const Register& r) const {
  if (setup_.watchdog_s * poll_hz_ < kFewestPeriods) {
    fail("watchdog is " + short_number(setup_.watchdog_s * 1e3) + " ms, allowed at poll_rate " + short_number(poll_hz_) +
         " Hz: at least three periods, " + short_number(kFewestPeriods / poll_hz_ * 1e3) + " ms");
  }
  const double value = watchdog_value(r, setup_.watchdog_s);
  if (value < r.minimum || value > r.maximum) {
    fail("watchdog is " + quantity(value, r) + ", allowed by " + setup_.map.file + ": " + short_number(r.minimum) + " to " +
         quantity(r.maximum, r));
  }
}

/// A serial line must have the time for all that a cycle asks.
void ModbusBlock::check_line() const {
  if (setup_.endpoint.tcp) return;
  std::vector<std::size_t> read = setup_.measurements;
  for (const char* name : {kStatusword, kFaultCode}) {
    if (const auto place = setup_.map.find(name)) read.push_back(*place);
  }
  const double least_s = line_time(setup_.map, setup_.set_points, read, setup_.endpoint.baud);
  if (least_s * poll_hz_ <= 1.0) return;
  fail("a cycle takes " + short_number(least_s * 1e3) + " ms on a line at " + std::to_string(setup_.endpoint.baud) +
       " baud, poll_rate " + short_number(poll_hz_) + " Hz leaves " + short_number(1e3 / poll_hz_) + " ms; allowed: at most " +
       short_number(1.0 / least_s, 3) + " Hz, or fewer registers, or a faster line");
}

void ModbusBlock::resolve(Facts& f) {
  f.delay(set_points, 1, [this] {
    std::vector<double> safe;
    for (const std::size_t place : setup_.set_points) safe.push_back(setup_.map.registers[place].safe);
    return safe;
  }());
  if (f.in(set_points).known) check_set_points(f.in(set_points));
  const auto state = [&](Out<double> port, std::vector<std::string> names, std::vector<std::string> units) {
    StreamFacts& y = f.out(port);
    y.known = true;
    y.channels = static_cast<int>(names.size());
    y.rate = Rate::from_hz(poll_hz_);
    y.channel_names = std::move(names);
    y.unit = std::all_of(units.begin(), units.end(), [&](const auto& u) { return u == units.front(); }) ? units.front() : "";
    y.channel_units = std::move(units);
  };
  const auto registers = [&](Out<double> port, const std::vector<std::size_t>& places) {
    std::vector<std::string> names, units;
    for (const std::size_t place : places) {
      const Register& r = setup_.map.registers[setup_.measurements[place]];
      names.push_back(r.name);
      units.push_back(r.unit);
    }
    state(port, std::move(names), std::move(units));
  };
  std::vector<std::size_t> all(setup_.measurements.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  registers(measurements, all);
  registers(feedback, feedback_);
  state(status, {"state", "enabled", "fault_code", "statusword", "late"}, {"1", "1", "1", "1", "1"});
}

void ModbusBlock::check_set_points(const StreamFacts& u) const {
  const std::size_t count = setup_.set_points.size();
  if (static_cast<std::size_t>(u.channels) != count) {
    fail("'set_points' has " + records::counted(u.channels, "channel") + ", parameter set_points names " +
         records::counted(static_cast<std::int64_t>(count), "register"));
  }
  if (std::abs(u.rate.hz() - poll_hz_) > 1e-9 * poll_hz_) {
    const bool faster = u.rate.hz() > poll_hz_;
    fail("'set_points' has " + short_number(u.rate.hz()) + " samples/s, the drive is polled " + short_number(poll_hz_) +
         " times a second (poll_rate)" +
         (faster ? ": the loop is faster than the drive takes set points; allowed: a slower loop, "
                   "or filters.decimate before the drive"
                 : "; allowed: the same rate (filters.hold raises it)"));
  }
  const records::Signals signals = records::signals_of(u, "set_points");
  for (std::size_t c = 0; c < count; ++c) {
    const Register& r = setup_.map.registers[setup_.set_points[c]];
    if (!bodeflow::same_unit(signals.units[c], r.unit)) {
      fail("set point '" + r.name + "' is in " + r.unit + ", channel " + std::to_string(c) + " of 'set_points' is in " +
           signals.units[c] + "; allowed: the same unit");
    }
  }
}

void ModbusBlock::advise(const Facts& f, Advice& a) {
  a.tell("drives " + name_of(setup_.endpoint) + ", " + short_number(poll_hz_) + " cycles a second; a loop through it has " +
         short_number(2e3 / poll_hz_) + " ms of delay" +
         (setup_.drives ? "; the drive's watchdog is set to " + short_number(setup_.watchdog_s * 1e3) + " ms" : ""));
  for (const std::size_t place : setup_.set_points) {
    const Register& r = setup_.map.registers[place];
    if (is_limited(r)) a.tell("set point " + limits_of(r) + ", beyond them the drive is stopped");
    if (!is_limited(r)) a.warn("set point '" + r.name + "' has no limits in " + setup_.map.file);
  }
  for (const std::size_t place : setup_.measurements) {
    const Register& r = setup_.map.registers[place];
    if (setup_.drives && is_limited(r))
      a.tell("measured " + limits_of(r) + ", beyond them the drive is stopped in the same cycle");
  }
  if (setup_.drives && !setup_.set_points.empty() && !f.in(set_points).known) {
    a.warn("nothing is connected to 'set_points': the drive is enabled with its safe set points");
  }
}

void ModbusBlock::activate(const Activation& a) {
  if (!a.realtime) {
    fail(
        "a real drive is behind this block, it can't run as fast as the computer: found run: {clock: simulated}, allowed: run: "
        "{clock: realtime, chunk: 1}");
  }
  if (a.max_count > 1) {
    fail("the engine hands over " + std::to_string(a.max_count) +
         " samples at once, which would reach the drive in a burst; allowed: one, by run: {clock: realtime, chunk: 1} and no "
         "stream that is slower than poll_rate");
  }
  wanted_.assign(setup_.set_points.size(), 0.0);
  auto session = Session::open(setup_);
  if (!session) fail(session.error().text);
  newest_ = (*session)->polled();
  log_info(setup_.map.device + " at " + name_of(setup_.endpoint) + " is in " + name_of(newest_.state));
  poller_ = std::make_unique<Poller>(std::move(*session), newest_);
}

void ModbusBlock::change(const Parameters& p) { command_ = command_of(p.text("command")); }

void ModbusBlock::stop_and_fail(const std::string& reason) { fail(reason + "; " + poller_->stop().text); }

void ModbusBlock::take_set_points(Io& io, std::size_t n) {
  for (std::size_t c = 0; c < wanted_.size(); ++c) {
    const Register& r = setup_.map.registers[setup_.set_points[c]];
    wanted_[c] = io.connected(set_points) ? io.read(set_points, static_cast<int>(c))[n] : r.safe;
    if (wanted_[c] >= r.minimum && wanted_[c] <= r.maximum) continue;
    const std::string found = std::isfinite(wanted_[c]) ? quantity(wanted_[c], r) : "not finite";
    stop_and_fail("limit violated: set point '" + r.name + "' is " + found + " at sample " + std::to_string(io.position() + n) +
                  ", allowed: " + short_number(r.minimum) + " to " + quantity(r.maximum, r));
  }
}

void ModbusBlock::process(Io& io) {
  for (std::size_t n = 0; n < io.count(); ++n) {
    take_set_points(io, n);
    if (auto done = poller_->exchange(command_, wanted_, newest_); !done) fail(done.error().text);
    write(io, n);
  }
}

void ModbusBlock::write(Io& io, std::size_t n) const {
  for (std::size_t c = 0; c < newest_.measurements.size(); ++c) {
    io.write(measurements, static_cast<int>(c))[n] = newest_.measurements[c];
  }
  for (std::size_t c = 0; c < feedback_.size(); ++c) {
    io.write(feedback, static_cast<int>(c))[n] = newest_.measurements[feedback_[c]];
  }
  const bool enabled = newest_.state == DriveState::operation_enabled;
  const double values[] = {static_cast<double>(newest_.state), enabled ? 1.0 : 0.0, newest_.fault_code,
                           static_cast<double>(newest_.statusword), static_cast<double>(poller_->counts().late)};
  for (std::size_t c = 0; c < std::size(values); ++c) io.write(status, static_cast<int>(c))[n] = values[c];
}

void ModbusBlock::finish(Io& io) {
  const Stopped& stopped = poller_->stop();
  const PollCounts counts = poller_->counts();
  const double cycles = static_cast<double>(std::max<std::int64_t>(counts.cycles, 1));
  RecordBuilder r("drive_report");
  r.set("device", setup_.map.device).set("endpoint", name_of(setup_.endpoint));
  r.set("samples", counts.samples).set("cycles", counts.cycles).set("late", counts.late).set("retried", counts.retried);
  r.set("mean_cycle_ms", counts.total_s / cycles * 1e3).set("longest_cycle_ms", counts.longest_s * 1e3);
  r.set("stopped", stopped.confirmed).set("stop", stopped.text);
  io.emit(report, r);
  if (static_cast<double>(counts.late) > kMuchLate * static_cast<double>(counts.samples)) {
    log_warning(std::to_string(counts.late) + " of " + std::to_string(counts.samples) + " samples came late: a cycle takes " +
                short_number(counts.total_s / cycles * 1e3) + " ms in the mean, " + short_number(counts.longest_s * 1e3) +
                " ms at most; lower poll_rate or read fewer registers, unless the machine itself was too busy");
  }
}

void ModbusBlock::deactivate() {
  if (!poller_) return;
  const Stopped& stopped = poller_->stop();
  if (stopped.confirmed) log_info(stopped.text);
  if (!stopped.confirmed) log_warning(stopped.text);
  poller_.reset();
}

}  // namespace bodeflow::drive::modbus
