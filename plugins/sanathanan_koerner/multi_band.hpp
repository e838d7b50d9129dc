#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fit.hpp"

namespace bodeflow::sanathanan_koerner {

struct MultiBandSettings {
  std::vector<double> cuts_rad_s;      ///< between the bands, rising; empty: sought
  std::vector<Eigen::Index> orders;    ///< one a band; empty: sought
  std::vector<double> prewarps_rad_s;  ///< one a band; empty: sought
  Eigen::Index most_bands = 3;         ///< where the cuts are sought
  Eigen::Index highest_order = 20;     ///< of a band and of the one-band fit, where they are sought
  double below = 0.1, above = 1e-4;    ///< weights of the lines below and above a band
  double weight_exponent = 1.0;
  bool monomial = false;    ///< powers of 1/z as printed in place of orthonormal polynomials
  int rounds = 25;          ///< most passes over all bands
  double tolerance = 1e-3;  ///< relative change of the error from round to round that counts as settled
};

/// The model of one band.
struct BandModel {
  double low_rad_s = 0.0, high_rad_s = 0.0;
  Eigen::Index order = 0;
  double prewarp_rad_s = 0.0;
  Fit fit;
};

/// A line of the log: a pass over the bands that take part so far.
struct Round {
  std::string phase;            ///< search, or final
  std::vector<int> iterations;  ///< of each band, 0 where it does not take part yet
  double error = 0.0;           ///< of the sum of the bands: weighted residual over the weighted data
};

struct MultiBandFit {
  std::vector<BandModel> bands;  ///< one: the one-band fit was better
  Eigen::MatrixXcd response;     ///< of the sum, at the lines
  double error = 0.0;
  double one_band_error = 0.0;  ///< the bound: of the best fit in one band
  Eigen::Index one_band_order = 0;
  std::vector<Round> log;
  std::string reason;
};

/// A sum of models, each fitted to what the others leave, over bands of the range.
///
/// Method: D. A. Jue's section 2.3.2 without a hand on it: the best fit in one band is the bound; the range is cut where the
/// smoothed response is flattest, in the lower half of what is left; the order of a band is the one that its own lines need;
/// the bands are fitted to the residuals of the others with tiered weights (equation 3) in turns, lower ones first, a further
/// one when they have settled; then all again from nothing with the orders and pre-warp frequencies found. More poles than one
/// band needs for the same error: use `fit` unless you want this method (example 2: 236 states at 1 % in three bands, 0.12 % in
/// one). Errors: those of check and of fit; cuts, orders or pre-warp frequencies whose numbers do not fit each other.
/// Sources: D. A. Jue, 1998, section 2.3; D. S. Bayard, High-order wide-band frequency domain identification using composite
/// curve fitting, American Control Conference, 1992, pp. 3181-3185, doi:10.23919/ACC.1992.4792699.
Expected<MultiBandFit> multi_band_fit(const Data& data, const MultiBandSettings& settings);

/// Where a range of lines is cut: the line whose neighbourhood has the least mean slope of log|G| over log omega, in the lower
/// half of first .. last. Nothing where the range is too short.
std::optional<Eigen::Index> flattest_line(const Data& data, Eigen::Index first, Eigen::Index last);

/// The parallel connection of the bands: one input, an output for each channel. Errors: those of state_space.
Expected<numerics::StateSpace> state_space(const MultiBandFit& fit);

}  // namespace bodeflow::sanathanan_koerner
