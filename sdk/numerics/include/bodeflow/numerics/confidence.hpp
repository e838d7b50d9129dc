#pragma once

/// Confidence regions of complex estimates.
namespace bodeflow::numerics {

/// The radius of the circle around an estimated complex number that holds the true one with probability `confidence`, in the unit
/// of the estimate.
///
/// variance: the estimate s^2 of E|dG|^2, at least 0, with `degrees_of_freedom` nu complex degrees of freedom (P - 1 for the mean
/// of P periods). For circular normal dG, |dG|^2 / s^2 is F(2, 2 nu) distributed, whose quantile has the closed form
///   F_c(2, 2 nu) = nu ((1 - c)^(-1/nu) - 1),
/// so the radius is sqrt(s^2 F_c). nu = infinity gives the limit for a known variance, sqrt(-s^2 ln(1 - c)); nu = 0 infinity: a
/// variance without degrees of freedom tells nothing. At nu = 3, 5, 11 the 95 % radius is 1.31, 1.17, 1.07 times that limit.
/// Ranges: nu >= 0 (not necessarily whole), 0 <= confidence < 1.
/// Assumption: noise circular, independent between the periods; exact for a known input, a good approximation where the input
/// stands 10 dB above its own noise.
/// Reference: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, section 2.4.2; N. L.
/// Johnson, S. Kotz, N. Balakrishnan, Continuous Univariate Distributions vol. 2, 1995, chapter 27 (F with 2 degrees above).
double confidence_radius(double variance, double degrees_of_freedom, double confidence);

}  // namespace bodeflow::numerics
