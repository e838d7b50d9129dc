#include "file_block.hpp"

BODEFLOW_PLUGIN("acquisition", "1.0.0", bodeflow::acquisition::FileBlock)
