#pragma once

#include <bodeflow/effect_description.hpp>
#include <bodeflow/error.hpp>
#include <bodeflow/plant.hpp>
#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// What is known before an effect is fitted: of the base model on the records, and of what it leaves.
struct Situation {
  std::string input_unit, output_unit;
  double sample_time_s = 0.0;
  double duration_s = 0.0;  ///< of the shortest record
  double input_peak = 0.0, input_rms = 0.0, output_peak = 0.0, output_rms = 0.0;
  double residual_mean = 0.0, residual_rms = 0.0;
  Place place;  ///< where it would act; empty for effects of input, output and response
  /// At the excited lines: the base model's response and what it leaves, (Y - Yhat) / U, with its standard deviation.
  std::vector<double> line_hz;
  std::vector<std::complex<double>> response, missing;
  std::vector<double> missing_std;
  std::vector<double> peaks_hz;  ///< tones between the lines, highest first
  std::vector<double> jumps_s;   ///< instants at which the residual changes its level or size, most distinct first
};

/// Something physical that a base model lacks and that a tracer can add to it. A class that derives from it has a default
/// constructor and `static void describe(DescribeEffect&)`. An effect is simulated inside the model: it never
/// sees the measured output. Its functions are pure: one object serves any number of simulations, on any thread. `p` are the
/// values of its parameters in the order of `parameters`.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Whether it can act there with these records; a reason why not, "" if it can.
  virtual std::string refuses(const Situation&) const { return {}; }
  virtual std::vector<FitParameter> parameters(const Situation& s) const = 0;
  /// Points from which the fit sets out, each with one value a parameter; at least one.
  virtual std::vector<std::vector<double>> starts(const Situation& s) const = 0;
  /// The effect with its values in words, as a part of a sentence: "dead time of the inverter, 10.80 V (+-0.04) lost against the
  /// current".
  virtual std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const = 0;

  /// Acts::law. The reaction at the end of the step. `memory` is what stood in `next` after the step before, zeros at the
  /// beginning; called several times a step with trial values, so `next` follows from the arguments alone.
  virtual Reaction react(const double* /*p*/, const Signals&, const double* /*memory*/, double* /*next*/) const { return {}; }
  /// Acts::input, Acts::output. The sample that takes the place of x, called once a sample in their order. `time_s` since the
  /// record began.
  virtual double map(const double* /*p*/, double x, double /*time_s*/, double* /*memory*/) const { return x; }
  /// Acts::immittance: Z(s). Acts::series: the factor. Acts::parallel: what is added, for a unit of the first input.
  virtual std::complex<double> transfer(const double* /*p*/, std::complex<double> /*s*/) const { return 1.0; }
  /// Acts::delay [s].
  virtual double delay_s(const double* /*p*/) const { return 0.0; }
  /// Acts::tone: the frequencies.
  virtual std::vector<double> tones_hz(const double* /*p*/) const { return {}; }
};

}  // namespace v0
}  // namespace bodeflow
