#pragma once

#include <memory>

#include "table.hpp"

namespace bodeflow::acquisition {

/// The endings of the files that `open_table` reads, for messages: ".csv, .txt ...".
std::string table_endings();

/// The reader for a file by its ending, in any case; what else the file says about its format is checked by the reader.
/// Errors: unknown ending, file that can't be opened, wrong or broken format.
Expected<std::unique_ptr<TableReader>> open_table(const std::string& path);

}  // namespace bodeflow::acquisition
