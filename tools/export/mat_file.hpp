#pragma once

#include "export/model_file.hpp"

namespace bodeflow::tools::exports {

/// A MATLAB file (version 5) with the variables A, B, C, D, Ts, delay, numerator and denominator where the model has them, and
/// input_names, output_names as cells of text.
std::string mat_of(const ModelFile& file);

/// The model of such a file, as this program or MATLAB (save -v6 or -v7) writes it: real matrices A, B, C and D are needed, Ts is
/// 0 and names are made up where they are absent. Systems of the control toolbox can't be read: they are MATLAB's own objects.
/// Error: no such file, cut off, damaged, a matrix that is absent or of another kind.
Result<ModelFile> model_in_mat(const std::string& name, const std::string& bytes);

}  // namespace bodeflow::tools::exports
