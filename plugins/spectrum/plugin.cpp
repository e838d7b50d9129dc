#include "averaging_dft_block.hpp"
#include "delay_block.hpp"
#include "goertzel_block.hpp"
#include "linearity_block.hpp"
#include "local_polynomial_block.hpp"
#include "merge_block.hpp"
#include "spectral_matrix_block.hpp"
#include "stepped_sine_block.hpp"
#include "welch_block.hpp"

BODEFLOW_PLUGIN("spectrum", "0.1.0", bodeflow::spectrum::AveragingDftBlock, bodeflow::spectrum::Goertzel,
                bodeflow::spectrum::SteppedSineBlock, bodeflow::spectrum::WelchBlock, bodeflow::spectrum::LocalPolynomialBlock,
                bodeflow::spectrum::MergeBlock, bodeflow::spectrum::DelayBlock, bodeflow::spectrum::SpectralMatrixBlock,
                bodeflow::spectrum::LinearityBlock)
