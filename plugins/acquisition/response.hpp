#pragma once

#include <bodeflow/error.hpp>
#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bodeflow::acquisition {

/// One element of a frequency response as a file holds it: from one input to one output.
struct ResponseElement {
  std::string quantity;  ///< its name in the file: "S21", "G11", "Z"
  std::string output, input;
  std::string unit;                         ///< "" where the file says none
  std::vector<std::complex<double>> value;  ///< one a point
  std::vector<double> variance;             ///< E|dG|^2, one a point; empty where the file says none
};

/// A frequency response file, read whole.
struct ResponseTable {
  std::string format;                ///< "Touchstone 1, S parameters ..."
  std::vector<double> frequency_hz;  ///< rising
  std::vector<ResponseElement> elements;
  std::vector<std::string> remarks;   ///< what to tell beside numbers
  std::vector<std::string> warnings;  ///< what may be wrong, with what to do
};

/// A frequency response: outputs x inputs at each point.
struct Response {
  std::string format;
  std::vector<double> frequency_hz;
  std::vector<std::string> output_names, input_names;
  std::vector<std::string> units;           ///< outputs x inputs, row-major
  std::vector<std::complex<double>> value;  ///< points x outputs x inputs
  std::vector<double> variance;             ///< the same, or empty
  std::vector<std::string> remarks, warnings;
};

/// What of a file is wanted.
struct ResponseSelection {
  std::vector<std::string> quantities;  ///< names ("S21", "G11") or their letters ("G": all of G11, G12 ...); none: all
  std::optional<std::pair<double, double>> band_hz;
};

/// More numbers than this in one file are refused: a response in memory stays below 1 GiB.
inline constexpr std::size_t kMostResponseValues = std::size_t{1} << 25;

/// The file's response, by its ending: .csv .txt .tsv .dat, .frd, .zma, .s1p to .s99p, .uff .unv .u58. The error begins with the
/// file's name and place, "file:line:column: what". Errors: an unknown ending; a file that can't be opened; what the readers
/// refuse.
Expected<ResponseTable> read_response(const std::string& path, const std::vector<std::string>& quantities);

/// The wanted part of a table as a matrix: outputs and inputs in the order in which they come first.
/// Errors: a quantity that the file does not have (with those that it has), one element twice, a missing element, no point in
/// the band, variances for some elements alone.
Expected<Response> assemble(ResponseTable table, const ResponseSelection& wanted);

/// True if a selection names the quantity: as it is, or by the letters before its indices.
bool is_wanted(const std::string& quantity, const std::vector<std::string>& quantities);

/// "linear grid, 25 kHz apart", "logarithmic grid, 35 points an octave", "irregular grid"; "" for fewer than 3 points.
std::string grid_text(const std::vector<double>& frequency_hz);

/// What the response is made of, in one sentence: points, band, grid, outputs x inputs, format, units.
std::string summary_of(const Response& response);

}  // namespace bodeflow::acquisition
