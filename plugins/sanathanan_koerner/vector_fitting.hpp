#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <vector>

#include "data.hpp"
#include "iteration_watch.hpp"
#include "partial_fractions.hpp"

namespace bodeflow::sanathanan_koerner {

enum class Spacing { automatic, linear, logarithmic };

struct VectorFittingSettings {
  Eigen::Index order = 1;
  Spacing initial_poles = Spacing::automatic;
  bool stable = true;  ///< mirror unstable poles
  StopRule stop;
};

/// A model with the way that led to it.
struct VectorFit {
  PartialFractions model;
  Eigen::MatrixXcd response;  ///< at the lines
  Eigen::Index mirrored = 0;  ///< poles of the last step that were unstable and have been mirrored
  Course course;

  double error() const { return course.least(); }
};

/// Poles to start from, over that range: pairs -w/100 +- j w, and a real one for an odd order.
///
/// Linear spacing suits a structure with many modes, of which most lie in the upper decade, where logarithmic spacing leaves few
/// poles, which must wander there one iteration after the other (20 iterations in place of 4 with the 90 modes of D. A. Jue's
/// example 2). Logarithmic spacing is the better start for a few poles over many decades. spacing: one of the two.
PoleSet initial_poles(const Eigen::Vector2d& range_rad_s, Eigen::Index order, Spacing spacing);

/// The starts that a spacing means: one, over the active range; automatic: linear over the active range, linear and logarithmic
/// over that of all lines. data: some line above 0.
std::vector<PoleSet> starting_poles(const Data& data, Eigen::Index order, Spacing spacing);

/// First and last frequency of the part of the range where the weighted response moves: all but 1/200 of the way that it travels
/// from line to line lies between them on either side. Initial poles beyond it, where there are no modes, come back slowly (8
/// iterations in place of 3 with that example, and more than 40 in place of 15 where it has noise).
Eigen::Vector2d active_range(const Data& data);

/// The model in partial fractions of that order by relaxed vector fitting, in continuous time, the best of its iterates; from
/// several starts the best of them (race.hpp).
///
/// Method: each iterate solves sigma g = n, both in fractions of the poles so far, with the mean of Re(sigma) held at 1; the
/// zeros of sigma, eigenvalues of A - b c'/d, are the next poles; those in the right half plane are mirrored. Then the residues
/// by least squares. The same problem as `fit`, in another basis. Cost: as fit. Errors: as fit. Sources: B. Gustavsen, A.
/// Semlyen, Rational approximation of frequency domain responses by vector fitting, IEEE Trans. Power Delivery 14, 1999,
/// doi:10.1109/61.772353; B. Gustavsen, 2006, doi:10.1109/TPWRD.2005.860281.
Expected<VectorFit> vector_fit(const Data& data, const VectorFittingSettings& settings);

/// The same from given poles, whose number is the order.
Expected<VectorFit> vector_fit(const Data& data, const VectorFittingSettings& settings, const PoleSet& start);

/// The partial fractions with those poles that fit the data best. Errors: those of check, check_order.
Expected<PartialFractions> fit_residues(const Data& data, const PoleSet& poles);

}  // namespace bodeflow::sanathanan_koerner
