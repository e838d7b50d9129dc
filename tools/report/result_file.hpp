#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "report/record.hpp"

namespace bodeflow::tools::report {

/// What result.json holds. `problems`: what could not be read, a sentence each; the rest is whole.
struct ResultFile {
  std::string graph;
  std::string status;
  std::vector<Record> records;
  std::vector<std::string> problems;
};

/// Reads result.json as a stream: numbers go straight into lists, so that a result of ten million lines needs little more than
/// its numbers. A file that is cut off or damaged gives the records before that place and a problem. Error: it can't be opened.
tl::expected<ResultFile, std::string> read_result(const std::filesystem::path& path);

}  // namespace bodeflow::tools::report
