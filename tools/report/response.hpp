#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "report/record.hpp"

namespace bodeflow::tools::report {

/// A `frequency_response` record whose arrays have been checked against each other.
struct Response {
  const Record* record = nullptr;
  std::vector<double> frequency;  ///< [Hz], ascending
  std::vector<std::size_t> line;  ///< where each stands in the record's arrays
  std::size_t outputs = 0;
  std::size_t inputs = 0;
  double confidence = 0.95;
  double degrees_of_freedom = 0.0;  ///< NaN: not known

  std::size_t lines() const { return frequency.size(); }
  std::string output(std::size_t i) const;
  std::string input(std::size_t j) const;
  std::string unit(std::size_t i, std::size_t j) const;
  std::string pair_name(std::size_t i, std::size_t j) const;  ///< "output / input"

  std::complex<double> value(std::size_t k, std::size_t i, std::size_t j) const;
  double radius(std::size_t k, std::size_t i, std::size_t j) const;  ///< of the confidence circle, NaN where not known
  double variance(std::size_t k, std::size_t i, std::size_t j) const;
  /// A real array of the response's shape, nullptr where absent.
  const Array* of_pairs(const std::string& name) const;
  /// An array lines x outputs (real, or complex where asked for), nullptr where absent.
  const Array* of_outputs(const std::string& name, bool complex = false) const;
  std::size_t at(std::size_t k, std::size_t i, std::size_t j) const { return (line[k] * outputs + i) * inputs + j; }
  std::size_t at(std::size_t k, std::size_t i) const { return line[k] * outputs + i; }

 private:
  friend std::optional<Response> read_response(const Record& record);
  const Array* response_ = nullptr;
  const Array* variance_ = nullptr;
  const Array* radius_ = nullptr;
};

/// Nothing where the record is no frequency response or lacks `frequency` (lines) and `response` (lines x outputs x inputs).
/// The radius is the record's own; where that is absent it follows from variance and degrees of freedom (those of the record, or
/// one less than its periods).
std::optional<Response> read_response(const Record& record);

}  // namespace bodeflow::tools::report
