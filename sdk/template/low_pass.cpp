#include "low_pass.hpp"

#include <cmath>

LowPass::LowPass(double corner_hz, double rate_hz) : rate_hz_(rate_hz) { set_corner(corner_hz); }

void LowPass::set_corner(double corner_hz) {
  constexpr double kPi = 3.14159265358979323846;
  a_ = -std::expm1(-2.0 * kPi * corner_hz / rate_hz_);
}
