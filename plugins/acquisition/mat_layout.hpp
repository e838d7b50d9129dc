#pragma once

#include <vector>

#include "mat_stream.hpp"

namespace bodeflow::acquisition {

enum class MatKind { v5, v73 };

/// A MATLAB file's kind, and where its variables stand (v5).
struct MatLayout {
  MatKind kind = MatKind::v5;
  bool big_endian = false;
  std::vector<MatExtent> variables;
};

/// Walks through a MATLAB file without reading its values. Its variables are whole, as far as their lengths tell.
/// Form: MathWorks, "MAT-File Format" (R2023b), chapter 1. Error: no MATLAB file, v4, cut off.
Expected<MatLayout> read_mat_layout(ByteSource& source);

}  // namespace bodeflow::acquisition
