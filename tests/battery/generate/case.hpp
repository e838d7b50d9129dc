#pragma once

#include <memory>
#include <string>
#include <vector>

#include "generate/hidden.hpp"

namespace battery {

enum class Kind { clean, single, outside };
std::string word(Kind kind);

/// What is to be drawn.
struct Wish {
  Kind kind = Kind::clean;
  std::string plant;   ///< motor, mechanical
  std::string effect;  ///< "" for clean
  std::string seed;    ///< of all random numbers of the case
};

struct CaseRecord {
  std::string name;  ///< E1, E2, V, T
  Drive drive;
  Series input, output;  ///< as measured
};

/// A plant that hides something or nothing, measured four times.
struct Case {
  std::string plant, input_unit, output_unit;
  double sample_time = 0.0;
  std::vector<CaseRecord> records;
  // The truth.
  Kind kind = Kind::clean;
  std::string effect = "none";
  double noise = 0.0;            ///< rms, of the output
  double signal_to_noise = 0.0;  ///< dB, at level 1
  bool coloured = false;
  double strength = 0.0;
  double size = 0.0;               ///< model error over noise, see model_error
  std::vector<Value> values;       ///< of the effect
  std::vector<double> parameters;  ///< of the plant
};

Case draw_case(const Wish& wish);

/// The effects that a plant can be given.
std::vector<std::string> effects_of(const std::string& plant, Kind kind);

}  // namespace battery
