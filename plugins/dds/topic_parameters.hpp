#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/transport.hpp>

namespace bodeflow::dds {

/// The parameters that all blocks of the family have.
void describe_topic(Describe& d);
/// And those of a block that writes.
void describe_writer(Describe& d);

/// What they say. Fails, by name: a topic without a name.
Topic read_topic(const Parameters& p);
void read_writer(const Parameters& p, Topic& topic);

/// The message that ends a topic after `position` samples.
bf_topic_message end_message(std::int64_t position);

}  // namespace bodeflow::dds
