#pragma once

#include "byte_source.hpp"

namespace bodeflow::acquisition {

enum class MatKind { v5, v73 };

/// Which kind of MATLAB file this is. Of v5 the variables are walked through, so that what is read later is whole.
/// `size`: bytes in the file. Error: no MATLAB file, v4, cut off.
Expected<MatKind> check_mat(ByteSource& source, std::int64_t size);

}  // namespace bodeflow::acquisition
