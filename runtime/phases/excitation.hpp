#pragma once

#include "phases/prepare.hpp"

namespace bodeflow::phases {

/// What one channel of a stream does in a run.
struct Extremes {
  double lowest = 0.0, highest = 0.0;  ///< of a complex stream: 0 and the greatest magnitude
  double largest_at_s = 0.0;           ///< when its magnitude is greatest
  double steepest = 0.0;               ///< change per second between neighbours
};

/// A stream that goes to a device, or to blocks that depend on one.
struct Excitation {
  graph::End from;
  std::vector<Extremes> channels;  ///< empty: no sample
};

/// What a phase puts on one stream input of a device.
struct DeviceInput {
  graph::End to;
  /// Blocks in front that make it unknown before the run: devices, and those that take records of earlier phases.
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

/// The excitation of a phase's devices, found before anything moves: blocks in front of them that depend on no device and on no
/// earlier phase are made anew and run by themselves, simulated, for at most `most_s` seconds of computing. No device is opened.
Excitations excitations_of(const graph::Phase& phase, const plan::Facts& facts, Registry& registry, double most_s = 10.0);

}  // namespace bodeflow::phases
