#pragma once

#include <bodeflow/error.hpp>
#include <optional>
#include <string>
#include <vector>

struct iio_channel;
struct iio_device;

namespace bodeflow::acquisition {

/// One attribute to be written: `name` of the device, or of a channel where that is given.
struct IioAttribute {
  std::string channel, name, value;
};

/// Reads "range=5" or "voltage0/hardwaregain=20". Error: what is wrong with the text.
Expected<IioAttribute> iio_attribute(const std::string& text);

/// Writes it. Errors: no such channel or attribute (with those that there are), or the driver's refusal.
Expected<void> write_attribute(const iio_device* device, const IioAttribute& attribute);

/// The number in an attribute of a channel; none where it has no such attribute. Error: it can't be read.
Expected<std::optional<double>> read_number(const iio_channel* channel, const char* name);

/// Sets the sampling rate by `sampling_frequency` of the device, else of the channel, and reads it back; none where neither has
/// one. Error: the driver refuses it.
Expected<std::optional<double>> set_rate(const iio_device* device, const iio_channel* channel, double rate_hz);

/// The system's words for an error that libiio gave.
std::string iio_error(int code);

}  // namespace bodeflow::acquisition
