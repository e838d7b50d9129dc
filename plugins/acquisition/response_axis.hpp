#pragma once

#include <optional>
#include <string>
#include <vector>

#include "line_reader.hpp"

namespace bodeflow::acquisition {

/// Collects the frequencies of a file's points and refuses what can't be one.
class FrequencyAxis {
 public:
  /// Takes the next frequency [Hz]. Errors: negative, equal to the one before, below it, too many points.
  Expected<void, TextError> add(double frequency_hz, std::int64_t line, std::int64_t column);

  std::vector<double> take() { return std::move(frequency_hz_); }
  const std::vector<double>& values() const { return frequency_hz_; }

 private:
  std::vector<double> frequency_hz_;
  std::int64_t last_line_ = 0;
};

/// Watches the phases of one element for the wrong unit.
class PhaseWatch {
 public:
  explicit PhaseWatch(bool degrees) : degrees_(degrees) {}

  /// Takes the next phase, as written.
  void add(double phase);

  /// What to tell the user, or nothing. Degrees that never leave +-pi but come near it, or jump by 2 pi, may be radians; radians
  /// that jump by some 360 may be degrees.
  std::optional<std::string> suspicion() const;

 private:
  bool degrees_;
  std::int64_t count_ = 0;
  double last_ = 0.0, greatest_ = 0.0, greatest_step_ = 0.0;
};

}  // namespace bodeflow::acquisition
