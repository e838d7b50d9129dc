// The reader of calibration files on arbitrary bytes: what it gives can be used, what it refuses it refuses with words.
#include "acquisition/device/calibration.hpp"

#include <cmath>
#include <cstdlib>
#include <string_view>

using namespace bodeflow::acquisition;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto source = open_memory(std::string_view(reinterpret_cast<const char*>(data), size));
  const auto rows = read_calibration(*source);
  if (!rows) {
    if (rows.error().text.empty()) std::abort();
    return 0;
  }
  if (rows->empty()) std::abort();
  for (const CalibrationRow& row : *rows) {
    const bool usable =
        !row.channel.empty() && std::isfinite(row.scale.gain) && row.scale.gain != 0.0 && std::isfinite(row.scale.offset);
    if (!usable || !scales_of(*rows, {row.channel})) std::abort();
  }
  return 0;
}
