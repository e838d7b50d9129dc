#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "report/record.hpp"

namespace bodeflow::tools::report {

/// A `model` record that can be evaluated over frequency.
///
/// `form` transfer_function: `numerator` and `denominator` in descending powers, one-dimensional for one output and input, or
/// outputs x inputs x coefficients (a one-dimensional denominator is common to all). `form` state_space: `A`, `B`, `C`, `D`.
/// An attribute `delay` [s] multiplies by exp(-s delay). `sample_time` [s] above 0 means discrete time. `hold` zero_order of a
/// continuous-time transfer function with `sample_rate` [Hz]: it was fitted to samples of a held input, and is evaluated as such.
struct Model {
  const Record* record = nullptr;
  std::size_t outputs = 0;
  std::size_t inputs = 0;
  double sample_time = 0.0;
  double delay = 0.0;
  double hold = 0.0;  ///< time over which the input was held, 0: not

  /// G at each frequency [Hz], of output i and input j at place i * inputs + j; a state space is evaluated once for all of them.
  std::vector<std::vector<std::complex<double>>> responses(const std::vector<double>& frequency) const;
};

/// Nothing for another record, another form, or arrays that do not fit each other.
std::optional<Model> read_model(const Record& record);

/// A root with its standard deviations, where the model tells them.
struct Root {
  std::complex<double> value;
  bool has_covariance = false;
  double real_variance = 0.0;
  double covariance = 0.0;  ///< of real and imaginary part
  double imaginary_variance = 0.0;
};

/// `poles` or `zeros` with `pole_covariance` or `zero_covariance` (n x 2 x 2, of real and imaginary part); where the record has
/// no such array, the roots of a transfer function of one input and output (`denominator`, `numerator`).
std::vector<Root> roots_of(const Record& record, bool poles);

}  // namespace bodeflow::tools::report
