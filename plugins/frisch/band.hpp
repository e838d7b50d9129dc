#pragma once

#include <bodeflow/record.hpp>
#include <cstdint>
#include <string>

#include "windows.hpp"

namespace bodeflow::frisch {

/// What was measured in one band. All spectra are unitary, 1/sqrt(N) sum x exp(...): white noise of variance v in the samples has
/// E|X|^2 = v.
struct Band {
  MeanSpectra mean;                 ///< over whole periods; variances of the mean, each line by itself
  double periods = 0.0;             ///< P that the mean is over; 0: the variances are no scatter of periods and can't be pooled
  double windows = 0.0;             ///< that `power` is over, overlapping or not
  double degrees_of_freedom = 0.0;  ///< complex ones of the variances of one line
  PowerSpectra power;               ///< no lines where there are none
  double sample_rate_hz = 0.0;      ///< 0: not known
  std::int64_t period = 0;          ///< N, samples; 0: not known
  std::string input_name = "input", output_name = "output";
  std::string input_unit, output_unit;

  bool has_scatter() const { return periods >= 2.0; }
  Eigen::VectorXd frequency_hz() const;
  /// "0.122 to 5.74 Hz".
  std::string range() const;
};

/// The band of a record `frequency_response`. With mean spectra: those, and products over its whole periods, which mean and
/// variance of the mean give: mean |X_p|^2 = |X|^2 + (P - 1) var X. Without (imported, merged): a known input of 1 and the
/// response with its variance as output. Errors: those of records::read_response; more than one input or output; neither mean
/// spectra nor variance; mean spectra without period or number of periods.
Expected<Band> band_of_response(const RecordView& record);

/// The band of a record `spectral_matrix`. Errors, by name: another type; more than one input or output; arrays and attributes
/// that are absent or do not fit each other.
Expected<Band> band_of_matrix(const RecordView& record);

/// The band of samples of a periodic steady state: means over whole periods, products over windows `step` apart. Errors: those of
/// window_spectra; fewer than 2 periods.
Expected<Band> band_of_samples(const Eigen::VectorXd& input, const Eigen::VectorXd& output, Eigen::Index period,
                               Eigen::Index step, const std::vector<Eigen::Index>& lines, double sample_rate_hz);

/// The lines within low .. high [rad/s], ends included. Errors: no line is left.
Expected<Band> part_of(const Band& band, double low_rad_s, double high_rad_s);

/// The noise of one window, pooled over the lines of a band: the same as pooled_noise of the windows themselves.
PooledNoise pooled_noise(const Band& band);

/// The mean spectra with the pooled noise in place of each line's own. Bands without scatter stay as they are.
/// correlated: false takes the noises of input and output as uncorrelated.
MeanSpectra with_pooled_noise(const Band& band, bool correlated);

/// The probability that variances of the lines as unequal as these come from noise that is the same at all of them: Bartlett's
/// test, the lesser one of input and output, doubled. 1 where a variance is 0 or there is no scatter.
/// Reference: M. S. Bartlett, Proc. Royal Society A 160 (1937) 268, doi:10.1098/rspa.1937.0109.
double noise_flatness(const Band& band);

}  // namespace bodeflow::frisch
