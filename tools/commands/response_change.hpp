#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plugins/registry.hpp"

namespace bodeflow::tools {

/// Two frequency responses whose change is wanted: files, run directories or their result.json.
struct ResponseChangeOptions {
  std::vector<std::string> repeats;  ///< the first measured again
  std::string scatter;               ///< relative, such as "0.5 %"; empty: not stated
  std::string name;                  ///< of the response in the runs' results; empty: the only one
};

/// Whether the path is that of a frequency response: a file of one, or a run that left one and no model (or one of that name).
/// Error: a file that is neither a response nor a result.json.
tl::expected<bool, std::string> is_response(const std::string& path, const std::string& name, Registry& registry);

/// The graph that compares them.
std::string response_change_graph(const std::string& before, const std::string& after, const ResponseChangeOptions& options);

}  // namespace bodeflow::tools
