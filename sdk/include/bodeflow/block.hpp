#pragma once

// All that an author of blocks needs: derive from bodeflow::Block, describe it, name it in BODEFLOW_PLUGIN.
#include <bodeflow/block_base.hpp>
#include <bodeflow/plugin.hpp>
