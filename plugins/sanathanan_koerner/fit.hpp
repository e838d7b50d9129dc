#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <optional>

#include "arnoldi.hpp"
#include "data.hpp"
#include "iteration_watch.hpp"
#include "plane.hpp"
#include "rational.hpp"

namespace bodeflow::sanathanan_koerner {

/// A model with the way that led to it.
struct Fit {
  Rational model;
  Eigen::VectorXcd denominator;  ///< d at the lines
  Eigen::MatrixXcd response;     ///< of the model at the lines
  Eigen::VectorXcd poles;        ///< in s or z
  Eigen::Index reflected = 0;    ///< poles of the last step that were unstable and have been reflected
  Course course;

  double error() const { return course.least(); }
};

struct FitSettings {
  Eigen::Index order = 1;
  double weight_exponent = 1.0;  ///< of the weight 1/|d|^e: 1, or 0.5 for D. A. Jue's 1/sqrt|d|
  bool stable = true;            ///< reflect unstable poles
  StopRule stop;
};

/// The model of that order by the Sanathanan-Koerner iteration, the best of its iterates.
///
/// Method: each iterate minimises the sum over the channels of |q (g d - n)/d_before|^2 in polynomials that are orthonormal with
/// the weight q/|d_before| (arnoldi.hpp), with the numerators eliminated and the cost linear in the channels (elimination.hpp).
/// In place of a leading coefficient of 1 the mean of Re(d/d_before) is 1 (relaxed). Unstable poles are reflected into the disc,
/// which changes |d| on the circle by a constant alone. Biased by noise towards low damping of |g d - n|, much less than the
/// first (Levi) step; no proof of convergence: the best iterate is kept, and `course` says why the search ended.
/// start: d_before of the first step at the lines; empty: 1.
/// Errors: those of check, check_order; no iterate that is finite.
/// Sources: C. K. Sanathanan, J. Koerner, Transfer function synthesis as a ratio of two complex polynomials, IEEE Trans.
/// Automatic Control 8, 1963, doi:10.1109/TAC.1963.1105517; D. A. Jue, Frequency domain system identification with a rational,
/// multi-band, curve-fitting approach, 1998, section 2.2; B. Gustavsen, Improving the pole relocating properties of vector
/// fitting, IEEE Trans. Power Delivery 21, 2006, doi:10.1109/TPWRD.2005.860281.
Expected<Fit> fit(const Data& data, const Plane& plane, const FitSettings& settings, const Eigen::VectorXcd& start = {});

/// The model with the denominator whose values at the lines are given, and the best numerators for it.
/// Errors: those of arnoldi and roots_of.
Expected<Fit> with_denominator(const Data& data, const Plane& plane, const Eigen::VectorXcd& denominator, Eigen::Index order);

/// d(z) at the lines with its unstable roots reflected: each factor z - p becomes (z - 1/conj(p)) |p|. Gives how many there were.
Eigen::Index reflect(const Eigen::VectorXcd& roots, const Eigen::VectorXcd& z, Eigen::VectorXcd& denominator);

/// Pre-warp frequencies to try: `count` from the geometric mean of the range to ten times that.
Eigen::VectorXd prewarp_candidates(const Eigen::VectorXd& omega_rad_s, Eigen::Index count = 5);

/// d(z) of given poles (in s or z) at the lines, up to a factor.
Eigen::VectorXcd denominator_of(const Eigen::VectorXcd& poles, const Plane& plane, const Eigen::VectorXd& omega_rad_s);

/// `fit` in continuous time from several starts, the best of them (race.hpp): d = 1 at each of the pre-warp frequencies, which is
/// (s + a)^order, and the first poles of vector fitting. Errors: as fit, of the first start, where none of them gives a model.
Expected<Fit> fit_with_scan(const Data& data, const FitSettings& settings);

}  // namespace bodeflow::sanathanan_koerner
