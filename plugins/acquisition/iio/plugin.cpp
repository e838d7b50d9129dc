#include "iio_block.hpp"

BODEFLOW_PLUGIN("acquisition_iio", "0.1.0", bodeflow::acquisition::IioCapture)
