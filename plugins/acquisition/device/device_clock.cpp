#include "device_clock.hpp"

#include <time.h>

namespace bodeflow::acquisition {
namespace {

// Two stamps of 0.1 ms error each tell a rate to 0.03 % over this time; over less nothing is told.
constexpr double kShortest_s = 0.5;

}  // namespace

void DeviceClock::add(TimeStamp stamp) {
  last_ = stamp;
  if (now_) {
    now_->last = stamp;
  } else {
    now_ = Stretch{stamp, stamp};
  }
  if (!longest_ || now_->duration_s() >= longest_->duration_s()) longest_ = now_;
  if (!stamps_.empty() && stamp.time_s - stamps_.back().time_s < spacing_s_) return;
  if (stamps_.size() == kMost) {
    for (std::size_t i = 0; 2 * i < stamps_.size(); ++i) stamps_[i] = stamps_[2 * i];
    stamps_.resize(kMost / 2);
    spacing_s_ *= 2;
  }
  stamps_.push_back(stamp);
}

void DeviceClock::start_anew(TimeStamp first) {
  now_.reset();
  last_ = first;
}

void DeviceClock::reset() {
  *this = DeviceClock();
  stamps_.reserve(kMost);
}

std::optional<double> DeviceClock::rate_hz() const {
  if (!longest_ || longest_->duration_s() < kShortest_s) return std::nullopt;
  return static_cast<double>(longest_->last.position - longest_->first.position) / longest_->duration_s();
}

double monotonic_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace bodeflow::acquisition
