#pragma once

#include <string>
#include <string_view>

namespace bodeflow::acquisition {

/// What a channel of Linux IIO measures: value = factor * (raw + offset) * scale + zero, in `unit`, where `offset` and `scale`
/// are its attributes.
struct IioQuantity {
  std::string unit;  ///< "" where the kernel states none
  double factor = 1.0;
  double zero = 0.0;
};

/// By the channel's id: `voltage0` is in V, `accel_x` in m/s^2. The kernel's units are those of its document
/// Documentation/ABI/testing/sysfs-bus-iio: mV, mA, mW, thousandths of a degree Celsius, kPa ...
IioQuantity iio_quantity(std::string_view channel_id);

}  // namespace bodeflow::acquisition
