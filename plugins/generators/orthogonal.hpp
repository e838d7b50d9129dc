#pragma once

#include <complex>
#include <cstddef>

namespace bodeflow::generators {

/// True if the orthogonal matrix of that size is one of signs: a power of two.
bool has_signs_only(std::size_t size);

/// The entry of experiment e and channel j of a matrix W with entries of modulus 1 and W W^H = n I, n = `size` >= 1: Sylvester's
/// Hadamard matrix where n is a power of two, so that all experiments have the same peaks, the matrix of the Fourier transform,
/// exp(2 pi i e j / n), elsewhere.
/// Reference: T. P. Dobrowiecki, J. Schoukens, P. Guillaume, "Optimized excitation signals for MIMO frequency response function
/// measurements", IEEE Trans. Instrum. Meas. 55, 2006.
std::complex<double> orthogonal_entry(std::size_t experiment, std::size_t channel, std::size_t size);

}  // namespace bodeflow::generators
