#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plugins/registry.hpp"

namespace bodeflow::tools {

/// A data file of a one-off command, and what of it is used.
struct DataOptions {
  std::string file;
  std::vector<std::string> inputs, outputs;  ///< names of columns
  std::string rate;                          ///< such as "10 kHz"; empty: the file's own
};

/// Adds --input and --output.
void add_columns_to(CLI::App& command, DataOptions& options);

enum class DataKind { time_series, frequency_response };

/// What the file holds: a frequency response where acquisition.frequency_response can read it, else samples over time. Only
/// files that may be either are read for it.
/// Error: no such file; samples without the names of columns (with those that the file has).
tl::expected<DataKind, std::string> data_kind(const DataOptions& options, Registry& registry);

/// How long the samples over time in the file last. Error: why they can't be read.
tl::expected<double, std::string> duration_of(const DataOptions& options, Registry& registry);

/// The line of a graph that makes the block `data` of it.
std::string data_block(const DataOptions& options, DataKind kind);

/// A text as a scalar of a graph file that means this text and nothing else.
std::string yaml_text(const std::string& text);
/// Such texts as a list.
std::string yaml_text(const std::vector<std::string>& texts);

}  // namespace bodeflow::tools
