#pragma once

#include <string>
#include <vector>

#include "acquisition/line_reader.hpp"

namespace bodeflow::acquisition {

/// How a reading of a channel becomes a physical value: gain * reading + offset, in `unit`.
struct ChannelScale {
  double gain = 1.0;
  double offset = 0.0;
  std::string unit;
};

/// One row of a calibration file.
struct CalibrationRow {
  std::string channel;
  ChannelScale scale;
};

/// The rows of a calibration table: CSV with the columns `channel` and `gain`, and `offset` (0) and `unit` ("") where they
/// stand; others may hold anything. Separators, comments and quotes as in open_csv; decimal points alone.
/// Refused with the place: a header without `channel` or `gain`, a column twice, rows with more or fewer fields, a channel
/// without a name or twice, numbers that are none or not finite, a gain of zero, unknown units, no row at all.
Expected<std::vector<CalibrationRow>, TextError> read_calibration(ByteSource& source);

/// The scale of each channel, in their order. Refused: a channel that the rows do not have. Rows of other channels are left.
Expected<std::vector<ChannelScale>> scales_of(const std::vector<CalibrationRow>& rows, const std::vector<std::string>& channels);

}  // namespace bodeflow::acquisition
