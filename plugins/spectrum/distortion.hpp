#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "moments.hpp"

namespace bodeflow::spectrum {

/// Levels of the signals at all lines of a band, |mean| beside the standard deviation of the mean, rms over experiments and
/// realisations. Rows: lines.
struct Levels {
  enum Kind : std::int64_t { excited = 0, odd = 1, even = 2 };
  std::vector<std::int64_t> lines;
  std::vector<std::int64_t> kind;              ///< Kind of each line
  Eigen::MatrixXd input_level, input_noise;    ///< lines x inputs
  Eigen::MatrixXd output_level, output_noise;  ///< lines x outputs; noise: empty where unknown
};

/// The levels from `first` to `last`. Excited are the lines of `estimated`, and all where the excitation (the reference,
/// where there is one) is at least kExcited of its strongest line of the band. What is unexcited holds what the plant makes of
/// the excited lines: even lines its even, odd lines its odd nonlinearity, beside noise and beside what the input itself has
/// there.
///
/// Assumption: a multisine that leaves lines out, odd and even ones (detection lines); steady state.
/// Reference: R. Pintelon, J. Schoukens, System Identification, 2nd ed. 2012, section 4.3 (fast method).
Levels levels_of(const Measured& measured, const std::vector<std::int64_t>& estimated, std::int64_t first, std::int64_t last);
constexpr double kExcited = 0.1;

/// Root mean squares over the lines of one kind.
struct KindLevel {
  std::int64_t lines = 0;
  Eigen::VectorXd level;  ///< of each output
};
KindLevel rms_of(const Levels& levels, Levels::Kind kind);

/// Root mean square of the noise of each output over the unexcited lines; over all where there are none.
Eigen::VectorXd rms_noise(const Levels& levels);

/// The output level at the unexcited lines of `kind` next to each of `lines`: rms of the nearest one below and the nearest above;
/// lines x outputs, empty where the band has no such line.
Eigen::MatrixXd level_beside(const Levels& levels, const std::vector<std::int64_t>& lines, Levels::Kind kind);

}  // namespace bodeflow::spectrum
