#include "response_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "number_line.hpp"
#include "response.hpp"
#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

// With fewer points nothing can be said of the unit of a phase.
constexpr std::int64_t kFewest = 10;
// Phases of +-180 deg come that near to their limit in most files: 2.5 of pi.
constexpr double kNear = 2.5;

}  // namespace

Expected<void, TextError> FrequencyAxis::add(double frequency_hz, std::int64_t line, std::int64_t column) {
  if (frequency_hz < 0.0) return refused_at(line, column, "frequency " + number_text(frequency_hz) + " Hz; at least 0");
  if (!frequency_hz_.empty() && !(frequency_hz > frequency_hz_.back())) {
    const std::string before = " in line " + std::to_string(last_line_);
    if (frequency_hz < frequency_hz_.back()) {
      return refused_at(line, column,
                        "frequencies do not rise: " + number_text(frequency_hz) + " Hz after " +
                            number_text(frequency_hz_.back()) + " Hz" + before);
    }
    return refused_at(line, column, "point at " + number_text(frequency_hz) + " Hz stands twice: it is" + before + " too");
  }
  if (frequency_hz_.size() >= kMostResponseValues) return refused_at(line, 0, "more than 33554432 points");
  frequency_hz_.push_back(frequency_hz);
  last_line_ = line;
  return {};
}

void PhaseWatch::add(double phase) {
  if (count_ > 0) greatest_step_ = std::max(greatest_step_, std::abs(phase - last_));
  greatest_ = std::max(greatest_, std::abs(phase));
  last_ = phase;
  ++count_;
}

std::optional<std::string> PhaseWatch::suspicion() const {
  using std::numbers::pi;
  if (count_ < kFewest) return std::nullopt;
  if (degrees_ && greatest_ <= pi * (1 + 1e-6) && greatest_ > kNear)
    return "all phases lie within +-" + short_text(greatest_) + " deg: are they radians?";
  if (!degrees_ && greatest_step_ > 300.0 && greatest_step_ <= 360.0 * (1 + 1e-6))
    return "the phase jumps by " + short_text(greatest_step_) + " rad between two points: are these degrees?";
  return std::nullopt;
}

}  // namespace bodeflow::acquisition
