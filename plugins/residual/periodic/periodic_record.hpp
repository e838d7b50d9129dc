#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "expected.hpp"
#include "model/joint_model.hpp"
#include "periodic/floor_of_bins.hpp"
#include "records/recording.hpp"

namespace bodeflow::residual {

/// What a bin of the spectrum was meant to hold.
enum class Kind { dc, excited, odd, even, skirt, between };

/// A periodic recording as a model is compared with it: the mean period of the inputs, and the spectrum of the output over the
/// whole record, bins 0 .. P (lines - 1), of which every P-th is a line of the period. Spectra are Fourier coefficients: a line
/// of peak value a has |Y| = a / 2.
struct PeriodicRecord {
  std::string input_name, output_name, input_unit, output_unit;
  double sample_rate_hz = 0.0;
  Eigen::Index period = 0;   ///< N, samples
  Eigen::Index periods = 0;  ///< P, steady ones
  Eigen::Index skip = 0;     ///< periods before them
  std::string checksum;      ///< of the samples used
  std::vector<double> known;
  Eigen::MatrixXd input;           ///< N x inputs: mean period that drives the model
  Eigen::MatrixXcd input_lines;    ///< lines x inputs, as measured
  Eigen::VectorXcd output;         ///< bins
  std::vector<Kind> kind;          ///< a bin each
  Eigen::VectorXd frequency_hz;    ///< a bin each
  Eigen::VectorXd variance;        ///< E|dY|^2 a bin, with what the noise of measured inputs adds at lines that drive the model
  Eigen::MatrixXd input_variance;  ///< lines x inputs: E|dU|^2 of the noise with which a measured input drives the model
  FloorOfBins floor;               ///< of `output`
  double input_rms = 0.0, input_peak = 0.0, output_rms = 0.0, output_peak = 0.0;  ///< of the mean period, first input

  Eigen::Index bins() const { return output.size(); }
  Eigen::Index lines() const { return (bins() - 1) / periods + 1; }
  bool is_line(Eigen::Index bin) const { return bin % periods == 0; }
  double sample_time_s() const { return 1.0 / sample_rate_hz; }
  double line_hz() const { return sample_rate_hz / static_cast<double>(period); }
};

/// The record that a recording holds. The excited lines are those it states, else those where the mean input stands out.
///
/// Method: whole-record spectrum; every P-th bin is a line of the period, the others hold noise alone unless something changes
/// from period to period. Measured inputs drive the model with their own noise, which adds |Y|^2 var(U) / |U|^2 at the excited
/// lines, and as much for a unit of it at the mean and at other lines that drive the model; the lines that an input does not
/// excite are set to zero where all of them hold no more than its noise. Errors, by name: other
/// channels than the base has inputs, no period, fewer than 2 periods, no excited line, one at or above the Nyquist frequency, an
/// output without noise.
Expected<PeriodicRecord> periodic_record(const records::Recording& recording, std::vector<double> known, const BaseModel& base);

/// Where the whitened values of a bin stand: the real part of bin 0, then real and imaginary part of bin 1, 2 ...
struct BinRows {
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
};
inline BinRows rows_of(Eigen::Index bin) { return bin == 0 ? BinRows{0, 1} : BinRows{2 * bin - 1, 2}; }

/// Values of bins in units of the noise's standard deviation.
Eigen::VectorXd whitened(const PeriodicRecord& record, const Eigen::VectorXcd& values);
/// And back.
Eigen::VectorXcd unwhitened(const PeriodicRecord& record, const Eigen::VectorXd& rows);

}  // namespace bodeflow::residual
