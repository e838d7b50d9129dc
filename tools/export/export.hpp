#pragma once

#include <string>
#include <tl/expected.hpp>

namespace bodeflow::tools::exports {

struct Request {
  std::string model;   ///< run directory, result.json, .mat or .m file
  std::string key;     ///< of the model in a result.json; empty: the only one
  std::string format;  ///< json, matlab, mat, python, fmu
  std::string name;    ///< of the file without ending; empty: after the model
};

struct Exported {
  std::string name;     ///< of the file without ending
  std::string content;  ///< of the file
  std::string summary;  ///< what the model is, in a line
};

/// The model as a file of that format. Error: why not, with the model's file.
tl::expected<Exported, std::string> exported(const Request& request);

/// ".json", ".m", ".mat", ".py", ".fmu".
const char* ending_of(const std::string& format);

}  // namespace bodeflow::tools::exports
