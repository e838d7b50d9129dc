#include "publish_block.hpp"
#include "publish_records_block.hpp"
#include "subscribe_block.hpp"
#include "subscribe_records_block.hpp"

BODEFLOW_PLUGIN("dds", "0.1.0", bodeflow::dds::PublishBlock, bodeflow::dds::PublishRecordsBlock, bodeflow::dds::SubscribeBlock,
                bodeflow::dds::SubscribeRecordsBlock)
