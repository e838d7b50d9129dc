#pragma once

#include <string>

namespace bodeflow::output {

/// The name of a file inside the run directory, as given. Ends with Failure for a name that is empty, absolute, leads out of
/// the directory or names a folder; which names the run itself uses is known only to it.
std::string checked_file_name(const std::string& name);

}  // namespace bodeflow::output
