#pragma once

#include <bodeflow/block.hpp>

#include "calibration.hpp"

namespace bodeflow::acquisition {

/// The channels of one direction of a device, and what their readings mean.
struct Channels {
  std::vector<std::string> names;
  std::vector<ChannelScale> scales;  ///< one a channel
  std::string calibration;           ///< the file that the scales come from, or ""

  /// The unit of all channels; "" where they differ.
  std::string unit() const;
  /// Writes names and units into the facts of a stream.
  void state(StreamFacts& facts) const;
};

/// How channels are scaled, as the parameters of a block give it.
struct ScaleSettings {
  std::vector<double> scale;
  std::string unit, calibration;
};

/// Describes `<prefix>scale`, `<prefix>unit` and `<prefix>calibration`. `reading`: what a scale multiplies.
void describe_scale(Describe& d, const std::string& prefix, const std::string& reading);

/// Reads them. Throws Failure where scale or unit stand beside a calibration.
ScaleSettings read_scale(const Parameters& p, const std::string& prefix);

/// The channels of these names. Throws Failure: a name twice, another number of scales, a scale of zero, an unknown unit, and
/// `file:line:column: what` of a calibration.
Channels make_channels(const ScaleSettings& settings, std::vector<std::string> names);

/// ch1, ch2 ...
std::vector<std::string> numbered_channels(int count);

}  // namespace bodeflow::acquisition
