#pragma once

#include <Eigen/Core>

#include "noise_variances.hpp"

namespace bodeflow::frisch {

/// Which ratio of corrected spectra is the response.
enum class ResponseForm {
  output,  ///< (yy - output noise) / conj(yu)
  input    ///< yu / (uu - input noise)
};

/// The response at each line by (10) of the paper. Both forms agree only at lines where Phi - noise is singular, that is, on the
/// envelope; elsewhere they bracket the response that lies between.
///
/// With noise {0, 0} these are the estimates without Frisch: form `output` is what the paper's "without Frisch" must mean (its
/// inductance is 12 % too small, as 1 + output noise / yy makes it), biased upwards; form `input` is the usual H1, biased
/// downwards by 1 + input noise / uu, which here is already within 1.5 %. Errors: a line without correlation (output), a power at
/// or below the noise (input), both named.
Expected<Eigen::VectorXcd> corrected_response(const PowerSpectra& spectra, const NoiseVariances& noise, ResponseForm form);

}  // namespace bodeflow::frisch
