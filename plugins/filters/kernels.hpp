#pragma once

#include <cstddef>

/// Loops of the filters, compiled once for each vector level (Activation::vector_level: 1 SSE2, 3 AVX2, 4 AVX-512). Every sum has
/// one order, no product is contracted into one: the bits are the same at every level and for every way to cut a stream.
namespace bodeflow::filters {

/// Channels that are filtered together, side by side in the vector unit.
inline constexpr std::size_t kLanes = 8;

/// After each tile of this many samples, counted from the start of the stream, states are looked at: one that became so small
/// that it would slow the processor down (denormal numbers) is set to zero.
inline constexpr std::size_t kTile = 64;

/// Second-order sections in series, for `groups` times 8 lanes: each lane has its own coefficients and its own or a shared input.
struct Cascade {
  const double* coefficients = nullptr;  ///< groups x sections x coefficients of a section x 8 lanes, 64-byte aligned
  double* states = nullptr;              ///< groups x sections x 2 x 8 lanes, 64-byte aligned
  std::size_t sections = 0;
  std::size_t lanes = 0;             ///< that are in use; the last group may have fewer than 8
  const double* const* x = nullptr;  ///< a lane's input
  double* const* y = nullptr;        ///< a lane's output; may be that lane's input, if no other lane reads it
  bool shared_input = false;         ///< all lanes have the input x[0]
};

/// Transposed direct form II, 5 coefficients b0, b1, b2, a1, a2 (a0 = 1):
/// y = b0 x + s1, s1 <- (b1 x + s2) - a1 y, s2 <- b2 x - a2 y.
/// `position`: samples filtered since the start. Returns whether all states are finite, as seen at the ends of tiles.
bool run_direct(const Cascade& cascade, std::size_t count, std::size_t position, int vector_level);

/// Rotations, 6 coefficients c, s, g, f1, f2, d (numerics::NarrowBandPass::Section):
/// y = (f1 x1 + f2 x2) + d u, x1 <- (c x1 - s x2) + g u, x2 <- s x1 + c x2.
bool run_rotations(const Cascade& cascade, std::size_t count, std::size_t position, int vector_level);

/// y[n] = sum_j h[j] x[n - j], j < taps, in rising order of j. x has taps - 1 samples before x[0].
void run_fir(const double* h, std::size_t taps, const double* x, double* y, std::size_t count, int vector_level);

}  // namespace bodeflow::filters
