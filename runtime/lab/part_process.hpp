#pragma once

#include <sys/types.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::lab {

/// Starts the process of a part, `command` and its `options`, with empty standard input. Error: why it could not be started.
tl::expected<pid_t, std::string> start_part(std::vector<std::string> command, const std::vector<std::string>& options);

/// "was ended by signal 9 (Killed)", "ended with exit code 1": a status of waitpid, for people.
std::string how_it_ended(int status);

}  // namespace bodeflow::lab
