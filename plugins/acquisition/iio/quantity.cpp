#include "quantity.hpp"

#include <array>

namespace bodeflow::acquisition {
namespace {

struct Kind {
  std::string_view name;
  const char* unit;
  double factor;
  double zero;
};

constexpr std::array<Kind, 13> kKinds{{{"voltage", "V", 1e-3, 0},
                                       {"altvoltage", "V", 1e-3, 0},
                                       {"current", "A", 1e-3, 0},
                                       {"power", "W", 1e-3, 0},
                                       {"accel", "m/s^2", 1, 0},
                                       {"anglvel", "rad/s", 1, 0},
                                       {"angl", "rad", 1, 0},
                                       {"magn", "T", 1e-4, 0},
                                       {"temp", "K", 1e-3, 273.15},
                                       {"pressure", "Pa", 1e3, 0},
                                       {"resistance", "ohm", 1, 0},
                                       {"capacitance", "F", 1e-9, 0},
                                       {"distance", "m", 1, 0}}};

}  // namespace

IioQuantity iio_quantity(std::string_view channel_id) {
  const std::string_view kind = channel_id.substr(0, channel_id.find_first_of("0123456789_-"));
  for (const Kind& k : kKinds)
    if (k.name == kind) return {k.unit, k.factor, k.zero};
  return {};
}

}  // namespace bodeflow::acquisition
