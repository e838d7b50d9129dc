#include "file_block.hpp"

BODEFLOW_PLUGIN("acquisition", "0.1.0", bodeflow::acquisition::FileBlock)
