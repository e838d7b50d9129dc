#pragma once

#include "export/model_file.hpp"

namespace bodeflow::tools::exports {

/// A script for MATLAB and Octave: matrices A, B, C, D, the sample time Ts, names, and where the control toolbox is there the
/// system `sys`. Numbers with 17 digits, which read back as the same doubles.
std::string matlab_of(const ModelFile& file);

/// The model of such a script, as this program writes them: assignments of matrices of numbers and of lists of texts. Error: a
/// matrix that is not there or can't be read.
Result<ModelFile> model_in_matlab(const std::string& name, const std::string& text);

/// A Python script with the matrices as NumPy arrays, and functions that make a scipy.signal and a python-control system of them.
std::string python_of(const ModelFile& file);

}  // namespace bodeflow::tools::exports
