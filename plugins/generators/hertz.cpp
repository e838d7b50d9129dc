#include "hertz.hpp"

#include <cstdio>

namespace bodeflow::generators {

std::string hertz(double frequency) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g Hz", frequency);
  return text;
}

}  // namespace bodeflow::generators
