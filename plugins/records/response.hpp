#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bodeflow::records {

/// Mean spectra of one input and one output with the covariance of the noise on these means, one entry a line.
struct MeanSpectra {
  Eigen::VectorXcd input;           ///< U
  Eigen::VectorXcd output;          ///< Y
  Eigen::VectorXd input_variance;   ///< E|dU|^2
  Eigen::VectorXd output_variance;  ///< E|dY|^2
  Eigen::VectorXcd covariance;      ///< E(dY conj dU)
};

/// A frequency response in memory, with what its record says about it. Matrices have a line in each row and in column
/// i * inputs + j the entry from input j to output i.
struct ResponseData {
  std::string form;
  std::string method;
  std::vector<std::string> input_names;
  std::vector<std::string> output_names;
  std::vector<std::string> response_units;  ///< one an entry
  std::vector<std::string> warnings;
  std::optional<std::int64_t> periods, realisations, period, dropped_samples;
  std::optional<double> sample_rate_hz;
  /// nu of all lines; nothing where it is not known, which counts as infinitely many.
  std::optional<double> degrees_of_freedom;
  /// How many lines before and behind a line share data with it, so that their errors are correlated; 0: none, all are
  /// independent.
  std::int64_t correlated_lines = 0;
  std::vector<double> input_amplitude;  ///< largest |input| of the data, one an input; empty where it is not known

  Eigen::VectorXd frequency_hz;
  std::vector<std::int64_t> lines;  ///< line numbers, or empty
  Eigen::MatrixXcd response;
  Eigen::MatrixXd variance;            ///< E|dG|^2; empty where it is not known
  Eigen::MatrixXd confidence_radius;   ///< empty: from `variance` and `degrees_of_freedom` when written
  std::optional<MeanSpectra> spectra;  ///< of one input and one output, where the record has them; read, not written

  Eigen::Index inputs() const { return static_cast<Eigen::Index>(input_names.size()); }
  Eigen::Index outputs() const { return static_cast<Eigen::Index>(output_names.size()); }
};

/// The probability that the circles of `confidence_radius` hold the true response with.
inline constexpr double kConfidence = 0.95;

/// What a record `frequency_response` holds of it. Errors, by name: another type, arrays that are absent or whose shapes do not
/// fit each other, values that are not finite, frequencies that do not rise, a negative variance. Names and units that are absent
/// become "input", "output" (numbered where there are several) and "".
Expected<ResponseData> read_response(const RecordView& record);

/// The record `frequency_response`, to which a method may add arrays of its own.
RecordBuilder write_response(const ResponseData& data);

}  // namespace bodeflow::records
