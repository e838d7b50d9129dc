#pragma once

#include <string>

namespace bodeflow::generators {

/// A frequency as text: "125 Hz".
std::string hertz(double frequency);

}  // namespace bodeflow::generators
