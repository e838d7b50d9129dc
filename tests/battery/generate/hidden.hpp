#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generate/motor.hpp"
#include "generate/oscillator.hpp"

namespace battery {

struct Value {
  std::string name, unit;
  double value = 0.0;
};

/// What a plant hides. The greater the strength, the more of it; 0 is none.
struct Hidden {
  std::string name;
  double first = 0.01;   ///< a strength to begin with
  double largest = 1.0;  ///< beyond that it were another machine
  /// Samples of the record. The random numbers are those of what is random in the effect itself, the same in every call.
  std::function<Series(const Drive&, double strength, Random&)> run;
  /// Values whose meaning does not depend on how the law is written.
  std::function<std::vector<Value>(double strength)> values = [](double) { return std::vector<Value>{}; };
};

/// Makes a hidden effect, with the details that are not its strength drawn.
template <class P>
struct Maker {
  std::string name;
  Hidden (*make)(const P&, const Scale&, Random&);
};

/// Effects that a catalogue of physical effects has, and effects that it has not, of each plant.
const std::vector<Maker<Motor>>& motor_effects();
const std::vector<Maker<Motor>>& motor_strangers();
const std::vector<Maker<Oscillator>>& oscillator_effects();
const std::vector<Maker<Oscillator>>& oscillator_strangers();

}  // namespace battery
