#pragma once

#include <bodeflow/error.hpp>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bodeflow::testing {

/// Parameters of one test of a block, by name, in the text of a graph: {"gain", "2.5"}, {"lines", "[1, 3, 5]"}. Names that begin
/// with '@' say what the suite feeds: @channels (1), @rate (1 kHz), @element (f64, c64), @firings (2600), @period (samples after
/// which the input repeats, but for noise of 1 %; all noise without), @channels.PORT (of one input), @note.PORT.NAME (the numbers
/// of a note that goes with its stream), @unconnected (the name of an optional input).
using Setting = std::vector<std::pair<std::string, std::string>>;

/// The settings to be tested of each block, by id.
using Settings = std::map<std::string, std::vector<Setting>>;

/// The settings in a text with one setting a line: `example.gain: gain = 2.5, mode = fast`. '#' begins a comment; commas
/// inside brackets or double quotes belong to the value. Error: the line that can't be read.
Expected<Settings, Error> parse_settings(std::string_view text);

/// The settings in a file. Error: it can't be read, or `file:line: why`.
Expected<Settings, Error> read_settings(const std::string& file);

}  // namespace bodeflow::testing
