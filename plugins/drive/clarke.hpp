#pragma once

#include <array>

/// Amplitude-invariant Clarke transform: a symmetric three-phase sine of peak value A is a vector of length A. Phase quantities
/// of a star; the zero sequence is dropped.
namespace bodeflow::drive {

inline constexpr double kSqrt3 = 1.7320508075688772935;

/// A vector in the stator frame: alpha along the axis of phase a, beta 90 electrical degrees ahead.
struct AlphaBeta {
  double alpha = 0.0;
  double beta = 0.0;
};

/// alpha = (2 a - b - c) / 3, beta = (b - c) / sqrt 3.
constexpr AlphaBeta clarke(double a, double b, double c) { return {(2.0 * a - b - c) / 3.0, (b - c) / kSqrt3}; }

/// The phases a, b, c of a vector; their sum is zero.
constexpr std::array<double, 3> phases(AlphaBeta v) {
  return {v.alpha, 0.5 * (kSqrt3 * v.beta - v.alpha), -0.5 * (v.alpha + kSqrt3 * v.beta)};
}

}  // namespace bodeflow::drive
