#pragma once

#include <bodeflow/facts.hpp>
#include <cstdint>
#include <span>
#include <string>

#include "sensor_errors.hpp"

namespace bodeflow::drive {

/// Fails for a stream whose unit is stated and is another one.
void check_unit(const StreamFacts& facts, const std::string& unit);

/// Fails for a value that is not finite, with channel and sample; `first` is the index of x[0].
void check_finite(std::span<const double> x, int channel, std::uint64_t first);

/// Fails for hidden properties that arrive before sample `position` and not before the first: a bench does not change while it
/// runs.
void check_at_start(std::uint64_t position);

/// Brings the note `noise.std` up to date: noise of the input, which `filtered` makes coloured, times gain, and the sensor's.
void add_noise_note(StreamFacts& output, const SensorErrors& errors, bool filtered);

}  // namespace bodeflow::drive
