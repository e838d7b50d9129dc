#pragma once

#include <cstdint>
#include <string>

#include "graph/graph.hpp"

namespace bodeflow::plan {

/// "block.port" of a stream or message end; the parameter port is "block.parameters".
std::string stream_output(const graph::Phase& phase, const graph::End& end);
std::string stream_input(const graph::Phase& phase, const graph::End& end);
std::string message_output(const graph::Phase& phase, const graph::End& end);
std::string message_input(const graph::Phase& phase, const graph::End& end);

/// "a.out -> b.in".
std::string connection(const graph::Phase& phase, const graph::StreamEdge& edge);
std::string connection(const graph::Phase& phase, const graph::MessageEdge& edge);

/// "10 kHz"; "1.5 us"; "12.3 kB": the prefix that leaves the fewest zeros, up to ten digits.
std::string rate_text(const Rate& rate);
std::string seconds_text(double seconds);
std::string bytes_text(std::uint64_t bytes);

/// "1 sample", "2 samples".
std::string count_text(std::int64_t count, const std::string& noun);

/// "f64", "c64".
std::string element_text(std::uint32_t element);

}  // namespace bodeflow::plan
