#include "adc_block.hpp"
#include "file_block.hpp"
#include "frequency_response_block.hpp"
#include "recording_block.hpp"
#include "resample_block.hpp"
#include "result_block.hpp"

BODEFLOW_PLUGIN("acquisition", "0.1.0", bodeflow::acquisition::Adc, bodeflow::acquisition::FileBlock,
                bodeflow::acquisition::FrequencyResponseBlock, bodeflow::acquisition::RecordingBlock,
                bodeflow::acquisition::Resample, bodeflow::acquisition::ResultBlock)
