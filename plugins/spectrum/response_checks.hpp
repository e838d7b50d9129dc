#pragma once

#include <string>
#include <vector>

#include "distortion.hpp"
#include "estimate.hpp"

namespace bodeflow::spectrum {

/// What an estimate is judged by.
struct Judged {
  const Measured& measured;
  const Estimate& estimate;
  const Levels& levels;  ///< of the band of the estimate
  Form form = Form::errors_in_variables;
  double line_hz = 1.0;            ///< frequency of line 1
  std::vector<std::string> names;  ///< of inputs, outputs, references
  bool found_lines = false;        ///< no line was named: a threshold found them among all
};

/// What spoils the estimate or may do so, one text each with what to do about it; empty where all is well. In this order:
/// - fewer than 4 periods (realisations, where there are several); noise not separable from one period a realisation;
/// - periods left out as outliers;
/// - lines where the input (form reference: the reference) stands less than 10 dB above the deviation of its mean;
/// - successive periods that turn against each other: the period is not that of the excitation, or the clocks differ. The turn is
///   the slope over the lines of the angles between the first two and between first and last period, |slope| > 5 deviations;
/// - an excitation that does not repeat from period to period, or lines left out that carry power, see repetition_checks.hpp;
/// - power beside the excited lines of the input: leakage, or what an actuator adds;
/// - a signal that drifts, see repetition_checks.hpp; its ramp stands on all lines, so aliasing and distortion are not judged
/// then;
/// - an output that is constant;
/// - excited lines above 0.8 of the Nyquist frequency, or output power right below it that the input does not have: its level,
///   beside the strongest line, is less than a tenth of the output's;
/// - a first period that differs from the others more than the last one does: the transient is not over;
/// - inputs that the experiments hardly tell apart (condition above 20);
/// - realisations that repeat an excitation, see repetition_checks.hpp;
/// - nonlinear distortion three times the noise and more, with how many times.
std::vector<std::string> response_warnings(const Judged& judged);

/// How many samples longer than N the true period is, and its standard deviation, from the turn of the input's (the reference's)
/// lines between single periods of a part. `deviation` is infinite where nothing can be said: fewer than 3 lines or 2 periods.
struct PeriodError {
  double samples = 0.0;
  double deviation = 0.0;
};
PeriodError period_error(const Moments& moments, Eigen::Index signal, const std::vector<std::int64_t>& lines,
                         Eigen::Index period);

/// Mean over the lines of |Z_p - mean|^2 (P / (P - 1)) / s^2 for the first and the last period, s^2 the sample variance: 1 each
/// where all periods are alike. Zero with fewer than 3 periods.
struct EndPeriods {
  double first = 0.0;
  double last = 0.0;
};
EndPeriods end_periods(const Moments& moments, Eigen::Index signal, const std::vector<std::int64_t>& lines);

}  // namespace bodeflow::spectrum
