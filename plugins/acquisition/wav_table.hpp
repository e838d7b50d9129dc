#pragma once

#include <memory>

#include "table.hpp"

namespace bodeflow::acquisition {

/// A reader of sound files: WAV (RF64 and extensible too), W64 and FLAC. Channels are the columns ch1, ch2 ...; integer samples
/// are scaled so that full scale is +-1, floating-point ones are taken as they are.
/// Error: no such file, cut off, a header that never was completed, a coding that loses digits (A-law, ADPCM ...).
Expected<std::unique_ptr<TableReader>> open_sound(const std::string& path);

}  // namespace bodeflow::acquisition
