#include "session.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "identity.hpp"
#include "records/signals.hpp"
#include "register_value.hpp"

namespace bodeflow::drive::modbus {
namespace {

using numerics::Expected;
using numerics::refused;
using records::short_number;

constexpr auto kStopPoll = std::chrono::milliseconds(5);

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string hexadecimal(unsigned word) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04x", word);
  return text;
}

}  // namespace

Session::Session(SessionSetup setup, std::unique_ptr<Link> link)
    : s_(std::move(setup)),
      link_(std::move(link)),
      controlword_(s_.map.find(kControlword).value()),
      statusword_(s_.map.find(kStatusword).value()) {
  std::vector<std::size_t> all{statusword_};
  all.insert(all.end(), s_.measurements.begin(), s_.measurements.end());
  if (const auto code = s_.map.find(kFaultCode)) all.push_back(*code);
  read_ = group_registers(s_.map, all, kMostRead);
  written_ = group_registers(s_.map, s_.set_points, kMostWritten);
  values_.resize(all.size());
  polled_.measurements.resize(s_.measurements.size());
  words_.resize(kMostRead);
}

Expected<std::unique_ptr<Session>> Session::open(SessionSetup setup) {
  auto link = Link::open(setup.endpoint);
  if (!link) return tl::make_unexpected(link.error());
  std::unique_ptr<Session> session(new Session(std::move(setup), std::move(*link)));
  if (auto same = check_identity(*session->link_, session->s_.map); !same) return tl::make_unexpected(same.error());
  if (auto polled = session->poll(); !polled) return tl::make_unexpected(polled.error());
  const DriveState state = session->polled_.state;
  if (session->s_.drives && (state == DriveState::operation_enabled || state == DriveState::quick_stop_active)) {
    return refused(name_of(session->s_.endpoint) + ": the drive is in " + name_of(state) +
                   " already: another client or its panel drives it; allowed: a drive that is switched off");
  }
  return session;
}

Expected<void> Session::write_value(std::size_t place, double value) {
  const Register& r = s_.map.registers[place];
  const auto words = encoded(r, value);
  if (!words) return tl::make_unexpected(words.error());
  has_written_ = true;
  return link_->write(r.address, {words->data(), static_cast<std::size_t>(r.words())});
}

/// Writes a register, where it can be written, and reads it back.
Expected<void> Session::write_verified(const RegisterValue& wanted, const std::string& what) {
  const Register& r = s_.map.registers[wanted.place];
  if (r.writable()) {
    if (auto written = write_value(wanted.place, wanted.value); !written) return written;
  }
  if (!r.readable()) return {};
  const auto found = read_value(*link_, r);
  if (!found) return tl::make_unexpected(found.error());
  // Integers keep what is nearest; a float32 has 24 bits.
  const double rounding = r.encoding == Encoding::float32 ? std::abs(wanted.value) * 1e-6 : std::abs(r.scale) * 0.501;
  if (std::abs(*found - wanted.value) <= rounding) return {};
  return refused(name_of(s_.endpoint) + ": " + what + ": " + name_of(r) + " reads " + quantity(*found, r) + " where " +
                 quantity(wanted.value, r) + " is needed; the drive is not enabled");
}

Expected<void> Session::program_watchdog() {
  const auto place = s_.map.find(kWatchdog);
  if (!place) return refused(s_.map.file + " has no register 'watchdog': the drive would run on when this program ends");
  const Register& r = s_.map.registers[*place];
  const double wanted = watchdog_value(r, s_.watchdog_s);
  const auto words = encoded(r, wanted);
  if (words && !(decoded(r, words->data()) > 0.0)) {
    return refused(name_of(r) + " can't hold " + quantity(wanted, r) +
                   ": it would be 0, and the drive would run on when this program ends");
  }
  return write_verified({*place, wanted}, "the drive's communication watchdog");
}

/// What must stand in the drive before it is enabled.
Expected<void> Session::prepare() {
  if (auto programmed = program_watchdog(); !programmed) return programmed;
  for (const RegisterValue& value : s_.map.setup) {
    if (auto written = write_verified(value, "setup"); !written) return written;
  }
  prepared_ = true;
  return {};
}

std::string Session::fault() const {
  const auto code = s_.map.find(kFaultCode);
  return code ? "fault " + fault_text(static_cast<unsigned>(polled_.fault_code)) : "fault (the map has no fault_code)";
}

Expected<std::uint16_t> Session::next_word(DriveCommand command) {
  const DriveState state = polled_.state;
  if (command != DriveCommand::enable) {
    prepared_ = was_enabled_ = false;
    enabling_since_s_ = -1.0;
    return command == DriveCommand::disable ? kShutdown : kQuickStop;
  }
  if (enabling_since_s_ < 0.0) enabling_since_s_ = now_s();
  if (state == DriveState::fault) return last_word_ == kFaultReset ? kDisableVoltage : kFaultReset;
  if (prepared_) return toward_enabled(state);
  if (state != DriveState::switch_on_disabled) return kDisableVoltage;
  if (auto prepared = prepare(); !prepared) return tl::make_unexpected(prepared.error());
  return kShutdown;
}

Expected<void> Session::write_set_points(DriveCommand command, const std::vector<double>& set_points) {
  const bool live = command == DriveCommand::enable && polled_.state == DriveState::operation_enabled;
  for (const RegisterGroup& group : written_) {
    for (const auto& member : group.members) {
      const Register& r = s_.map.registers[member.place];
      const auto words = encoded(r, live ? set_points[member.index] : r.safe);
      if (!words) return tl::make_unexpected(words.error());
      for (int w = 0; w < r.words(); ++w) {
        words_[static_cast<std::size_t>(member.offset + w)] = (*words)[static_cast<std::size_t>(w)];
      }
    }
    has_written_ = true;
    if (auto written = link_->write(group.address, {words_.data(), static_cast<std::size_t>(group.words)}); !written) {
      return written;
    }
  }
  return {};
}

Expected<void> Session::poll() {
  for (const RegisterGroup& group : read_) {
    const std::span<std::uint16_t> to(words_.data(), static_cast<std::size_t>(group.words));
    if (auto read = link_->read(group.table, group.address, to); !read) return read;
    for (const auto& member : group.members) {
      values_[member.index] = decoded(s_.map.registers[member.place], to.data() + member.offset);
    }
  }
  std::copy_n(values_.begin() + 1, polled_.measurements.size(), polled_.measurements.begin());
  if (values_.size() > polled_.measurements.size() + 1) polled_.fault_code = values_.back();
  return take_statusword(values_[0]);
}

Expected<void> Session::take_statusword(double value) {
  polled_.statusword = static_cast<std::uint16_t>(value);
  const auto state = state_of(polled_.statusword);
  if (!state) {
    return refused(name_of(s_.endpoint) + ": statusword " + hexadecimal(polled_.statusword) +
                   " is no state of CiA 402: the register map does not fit the device");
  }
  polled_.state = *state;
  return {};
}

/// The statusword alone: a stop does not depend on what else can be read.
Expected<void> Session::read_state() {
  const auto word = read_value(*link_, s_.map.registers[statusword_]);
  if (!word) return tl::make_unexpected(word.error());
  return take_statusword(*word);
}

Expected<void> Session::check_measurements() const {
  for (std::size_t i = 0; i < s_.measurements.size(); ++i) {
    const Register& r = s_.map.registers[s_.measurements[i]];
    const double value = polled_.measurements[i];
    if (!std::isfinite(value)) return refused(name_of(s_.endpoint) + ": " + name_of(r) + " is not finite");
    if (value >= r.minimum && value <= r.maximum) continue;
    return refused(name_of(s_.endpoint) + ": limit violated: " + name_of(r) + " is " + quantity(value, r) +
                   ", allowed: " + short_number(r.minimum) + " to " + quantity(r.maximum, r));
  }
  return {};
}

/// What the state read means for the way on.
Expected<void> Session::judge(DriveCommand command, DriveState before) {
  const DriveState state = polled_.state;
  const std::string drive = name_of(s_.endpoint) + ": the drive ";
  const bool fails = state == DriveState::fault || state == DriveState::fault_reaction_active;
  if (fails && (was_enabled_ || prepared_)) return refused(drive + "has stopped by itself, " + fault());
  if (command != DriveCommand::enable) return {};
  if (fails && !s_.reset_faults) return refused(drive + "is in " + fault() + "; allowed: none, or reset_faults: true");
  if (state == DriveState::operation_enabled) {
    was_enabled_ = true;
    return {};
  }
  if (was_enabled_) {
    return refused(drive + "has left operation_enabled for " + std::string(name_of(state)) + " without a command (it was in " +
                   name_of(before) + ")");
  }
  if (enabling_since_s_ < 0.0 || now_s() - enabling_since_s_ <= s_.enable_time_s) return {};
  const bool remote = (polled_.statusword & kRemoteBit) != 0;
  return refused(drive + "is not enabled after " + short_number(s_.enable_time_s) + " s: it is in " +
                 (fails ? fault() : name_of(state)) + " (statusword " + hexadecimal(polled_.statusword) + ")" +
                 (remote ? "" : "; bit 9, remote, is 0: it listens to its panel"));
}

Expected<Polled> Session::cycle(DriveCommand command, const std::vector<double>& set_points) {
  const DriveState before = polled_.state;
  if (s_.drives) {
    const bool at_fault = before == DriveState::fault && command == DriveCommand::enable && !s_.reset_faults;
    if (!at_fault) {
      const auto word = next_word(command);
      if (!word) return tl::make_unexpected(word.error());
      if (auto written = write_set_points(command, set_points); !written) return tl::make_unexpected(written.error());
      if (auto written = write_value(controlword_, *word); !written) return tl::make_unexpected(written.error());
      last_word_ = *word;
    }
    if (s_.arm_trace && !armed_ && before == DriveState::operation_enabled) {
      if (auto written = write_value(s_.map.trace.value().arm.value(), 1.0); !written) {
        return tl::make_unexpected(written.error());
      }
      armed_ = true;
    }
  }
  if (auto read = poll(); !read) return tl::make_unexpected(read.error());
  if (s_.drives) {
    if (auto good = judge(command, before); !good) return tl::make_unexpected(good.error());
  }
  if (auto good = check_measurements(); !good) return tl::make_unexpected(good.error());
  return polled_;
}

/// Whether the motor stands, as far as the drive tells.
Expected<bool> Session::stands() {
  if (s_.map.standstill) {
    const auto speed = read_value(*link_, s_.map.registers[s_.map.standstill->place]);
    if (!speed) return tl::make_unexpected(speed.error());
    return std::abs(*speed) < s_.map.standstill->value;
  }
  return (polled_.statusword & kTargetReachedBit) != 0;
}

Expected<void> Session::stop_steps() {
  if (auto written = write_value(controlword_, kQuickStop); !written) return written;
  const double begun_s = now_s();
  while (now_s() - begun_s < s_.stop_time_s) {
    if (auto read = read_state(); !read) return read;
    if (is_off(polled_.state)) break;
    if (polled_.state == DriveState::quick_stop_active) {
      const auto there = stands();
      if (!there) return tl::make_unexpected(there.error());
      if (*there) break;
    }
    std::this_thread::sleep_for(kStopPoll);
  }
  if (auto written = write_value(controlword_, kDisableVoltage); !written) return written;
  if (auto read = read_state(); !read) return read;
  if (is_off(polled_.state)) return {};
  return refused("the drive is in " + std::string(name_of(polled_.state)) + " " + short_number(now_s() - begun_s) +
                 " s after quick stop and disable voltage");
}

Stopped Session::stop() {
  if (!s_.drives || !has_written_) return {true, "nothing was written to the drive"};
  Expected<void> stopped = stop_steps();
  if (!stopped) {
    const Expected<void> connected = link_->broken() ? link_->reconnect() : Expected<void>{};
    stopped = connected ? stop_steps() : connected;
  }
  if (stopped) return {true, "the drive was stopped and confirms " + std::string(name_of(polled_.state))};
  return {false, "the drive did not confirm that it stopped (" + stopped.error().text + "); its own watchdog of " +
                     short_number(s_.watchdog_s * 1e3) + " ms is left to stop it"};
}

}  // namespace bodeflow::drive::modbus
