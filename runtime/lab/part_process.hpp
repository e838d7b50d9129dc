#pragma once

#include <sys/types.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::lab {

/// Starts the process of a part, `command` and its `options`, with empty standard input. Error: why it could not be started.
tl::expected<pid_t, std::string> start_part(std::vector<std::string> command, const std::vector<std::string>& options);

}  // namespace bodeflow::lab
