#pragma once

#include "phases/prepare.hpp"

namespace bodeflow::phases {

/// Whether a block reaches what is outside of the run: a device, or a topic of the network.
bool is_outside(const graph::Block& block);

/// What one channel of a stream does in a run. Extremes are those of the finite samples.
struct Extremes {
  std::uint64_t finite = 0, not_finite = 0;  ///< samples
  double lowest = 0.0, highest = 0.0;        ///< of a complex stream those of the magnitude
  double largest_at_s = 0.0;                 ///< when the magnitude is greatest
  double steepest = 0.0;                     ///< change per second between neighbours, from 0 to the first one
};

/// A stream that goes outside, or to blocks that depend on what is there.
struct Excitation {
  graph::End from;
  std::vector<Extremes> channels;  ///< empty: no sample
};

/// What a phase puts on one stream input of a device or of the network.
struct DeviceInput {
  graph::End to;
  /// Blocks in front that make it unknown before the run: those outside, and those that take records of earlier phases.
  std::vector<int> depends_on;
  std::vector<std::size_t> excitations;  ///< the input's own where it depends on none, else what is known in front of it
};

struct Excitations {
  std::vector<DeviceInput> inputs;  ///< connected ones
  std::vector<Excitation> streams;
  double time_s = 0.0;  ///< of the run that was looked at
  bool whole = true;    ///< all of it
  std::string failure;  ///< why there are no streams
};

/// What a phase puts outside, found before anything moves: blocks in front that depend on nothing outside and on no earlier phase
/// are made anew and run by themselves, simulated, for at most `most_s` seconds of computing. No device is opened.
Excitations excitations_of(const graph::Phase& phase, const plan::Facts& facts, Registry& registry, double most_s = 10.0);

}  // namespace bodeflow::phases
