#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "expected.hpp"
#include "noise_floor.hpp"
#include "records/recording.hpp"

namespace bodeflow::residual {

/// What a line of the period was meant to hold.
enum class Kind { dc, excited, odd, even };

/// A periodic experiment of one input and one output as the tracer uses it: the mean period of the input, the mean spectrum of
/// the output over the lines 0 .. 1.25 times the last excited one, and the noise on it. Spectra are Fourier coefficients: a line
/// of peak value a has |Y| = a / 2.
struct Experiment {
  std::string name;  ///< "fit 1", "select" ...
  std::string input_name, output_name, input_unit, output_unit;
  double sample_rate_hz = 0.0;
  Eigen::Index period = 0;   ///< N, samples
  Eigen::Index periods = 0;  ///< P, that were averaged
  std::string checksum;      ///< of the samples used
  Eigen::VectorXd input;     ///< mean period, N samples
  Eigen::VectorXcd input_lines;
  Eigen::VectorXcd output;       ///< lines
  std::vector<Kind> kind;        ///< a line each
  Eigen::VectorXd frequency_hz;  ///< a line each
  Eigen::VectorXd variance;      ///< E|dY|^2 a line, with what the noise of a measured input adds at the excited ones
  NoiseFloor floor;              ///< of `output`
  Eigen::VectorXd between_hz;    ///< bins between the lines, in the same band
  Eigen::VectorXd between;       ///< |Y|^2 over the floor
  std::vector<bool> skirt;       ///< the bin is within 2 of an excited line

  Eigen::Index lines() const { return output.size(); }
  double sample_time_s() const { return 1.0 / sample_rate_hz; }
};

/// The experiment that a recording holds. The excited lines are those it states, else those where the mean input stands out.
///
/// Method: whole-record spectrum; every P-th bin is a line of the period, the others hold noise alone. A measured input drives
/// the model with its own noise, which adds |Y/U|^2 var(U) at the excited lines; the lines it does not excite are set to zero
/// where they hold no more than its noise. Errors, by name: several channels, no period, fewer than 2 periods, no excited line,
/// an excited line beyond 0.8 of the Nyquist frequency, an output without noise.
Expected<Experiment> experiment_of(const records::Recording& recording, const std::string& name);

}  // namespace bodeflow::residual
