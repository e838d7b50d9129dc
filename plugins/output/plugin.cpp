#include "csv_block.hpp"
#include "records_block.hpp"

BODEFLOW_PLUGIN("output", "0.1.0", bodeflow::output::CsvBlock, bodeflow::output::RecordsBlock)
