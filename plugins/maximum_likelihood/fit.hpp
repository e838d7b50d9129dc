#pragma once

#include <string>
#include <vector>

#include "line_correlation.hpp"
#include "rational.hpp"

namespace bodeflow::maximum_likelihood {

/// One of the starts that were tried.
struct Attempt {
  std::string start;  ///< how it was made
  double delay_s = 0.0;
  double start_cost = 0.0;
  double cost = 0.0;  ///< where its search ended
};

/// The model of least cost that was found.
struct Fit {
  Structure structure;  ///< with the delay fixed at the end of its range where the search left that
  Lines lines;          ///< as the free part of the model met them
  Minimum minimum;
  std::vector<Rational> models;  ///< one an output
  std::vector<Attempt> attempts;
  Eigen::Index reached = 0;  ///< how many attempts ended at the least cost, within 1e-6 of it
  bool delay_at_bound = false;
  Eigen::MatrixXcd residuals;  ///< normalised, lines x outputs, with the phase of U in them
  Eigen::MatrixXcd response;   ///< of the models at the lines, as it is measured: with delay and hold

  LineCorrelation correlation;  ///< of the residuals, where the errors of neighbouring lines are correlated
  double inflation = 1.0;       ///< see score_inflation

  Eigen::Index parameters() const { return structure.parameters(); }
};

/// The maximum likelihood estimate of a rational model for normal noise, independent from line to line and between outputs:
///   min sum_k sum_i |Y_i - G_i U|^2 / (var Y_i + |G_i|^2 var U - 2 Re(conj(G_i) cov_i)),   G_i = B_i / A exp(-s delay).
///
/// Several starts, each searched to its local minimum: iterated linear least squares of several kinds, at the best delays of a
/// grid where the delay is estimated; then the best with its unstable poles reflected, in case the search was caught on the wrong
/// side. `starts`: the most searches that are made; `grown_from`: a model of lower order whose cost must not be exceeded, or
/// null.
///
/// Assumptions: the noise on U is well below U (10 dB). Noise that outputs share, as that of U, is not used: with several outputs
/// the estimate is consistent and not efficient. A model may be unstable, or have a minimum that no start led to: look at
/// `attempts`. With hold: the images of the hold are those of the model before, iterated until they stay; consistent, and
/// efficient up to what the images depend on the parameters. References: R. Pintelon, J. Schoukens, System Identification: A
/// Frequency Domain Approach, 2nd ed. 2012, chapters 9 and 19 (delay, starts); R. Pintelon, P. Guillaume, Y. Rolain, J.
/// Schoukens, H. Van Hamme, IEEE Trans. Automatic Control 39 (1994) 2245. Errors: those of `check` for spectra and structure;
/// fewer equations than parameters; no start that can be searched.
Expected<Fit> fit_model(const Spectra& spectra, const Structure& structure, int starts, const Fit* grown_from = nullptr);

/// The range in which a delay is looked for where none is given: 0 to 5 periods of the highest line, and no further than the
/// spacing of the lines can tell, half a turn between neighbours.
double widest_delay(const Spectra& spectra);

}  // namespace bodeflow::maximum_likelihood
