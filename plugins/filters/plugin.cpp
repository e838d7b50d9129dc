#include <bodeflow/block.hpp>

#include "biquads_block.hpp"
#include "decimate_block.hpp"
#include "delay_block.hpp"
#include "disturbance_block.hpp"
#include "fir_block.hpp"
#include "gain_block.hpp"
#include "hold_block.hpp"
#include "iir_bank_block.hpp"
#include "iir_block.hpp"
#include "interpolate_block.hpp"
#include "moving_average_block.hpp"
#include "narrow_band_pass_block.hpp"
#include "notch_block.hpp"
#include "static_nonlinearity_block.hpp"
#include "sum_block.hpp"

using namespace bodeflow::filters;

BODEFLOW_PLUGIN("filters", "0.2.0", Gain, Delay, Hold, Decimate, StaticNonlinearity, Sum, Iir, IirBank, Biquads,
                NarrowBandPassBank, Notch, Disturbance, Fir, MovingAverageBlock, Interpolate)
