#pragma once

#include <string>

#include "byte_source.hpp"

namespace bodeflow::acquisition {

/// Walks through the chunks of a WAV or RF64 file and compares what their headers state with what is there; other files pass.
/// `size`: bytes in the file. Error: what does not fit.
Expected<void> check_riff(ByteSource& source, std::int64_t size);

}  // namespace bodeflow::acquisition
