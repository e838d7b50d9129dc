#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "multisine.hpp"

namespace bodeflow::generators {

enum class Phases { schroeder, random, zero, optimised };

/// What the signals of all experiments have in common.
struct Design {
  std::int64_t period = 0;  ///< N
  std::vector<Line> lines;  ///< their phases are not used
  Phases phases = Phases::schroeder;
  std::size_t inputs = 1;  ///< channels, and experiments of a realisation
  std::size_t realisations = 1;
  std::vector<double> rms;   ///< of each channel; empty: as the lines' amplitudes give it
  std::vector<double> peak;  ///< largest value of each channel in any experiment; empty: as it comes
};

/// One period of each channel in each experiment of each realisation.
///
/// Channel j has phases of its own in each realisation if they are random (or optimised, with more than one realisation or input:
/// then the optimiser starts from random ones). Experiment e of n multiplies its spectrum by W_ej, W orthogonal: n experiments
/// excite all directions of the inputs evenly, at every line.
class Experiments {
 public:
  /// Random numbers come from the streams of `seed`: stream m * inputs + j for realisation m, channel j.
  Experiments(const Design& design, std::uint64_t seed);

  /// The samples from `at` on, within the period.
  void copy(std::size_t realisation, std::size_t experiment, std::size_t channel, std::size_t at, std::span<double> y) const;

  /// The largest crest factor of a channel in an experiment.
  double crest_factor() const { return crest_factor_; }
  /// What the lines' amplitudes of each channel are multiplied by.
  const std::vector<double>& scales() const { return scales_; }

  /// Values that a design keeps in memory.
  static double values(const Design& design);
  /// True if its signals depend on the seed.
  static bool seeded(const Design& design);

 private:
  void scale(const Design& design);
  std::vector<double> period_of(std::size_t realisation, std::size_t experiment, std::size_t channel) const;

  std::size_t period_, inputs_;
  // Realisation by realisation, channel by channel; no imaginary parts where the orthogonal matrix has none.
  std::vector<std::vector<double>> real_, imaginary_;
  std::vector<double> scales_;
  double crest_factor_ = 0;
};

}  // namespace bodeflow::generators
