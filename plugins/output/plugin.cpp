#include "csv_block.hpp"
#include "records_block.hpp"

BODEFLOW_PLUGIN("output", "1.0.0", bodeflow::output::CsvBlock, bodeflow::output::RecordsBlock)
