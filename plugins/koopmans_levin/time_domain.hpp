#pragma once

#include <Eigen/Core>

#include "factors.hpp"

namespace bodeflow::koopmans_levin {

/// The factors of the classical time-domain method, for `solve`: rows [y(t-n) .. y(t) | u(t-n) .. u(t)], t = n .. N-1, QR in
/// blocks, scaled by 1/N.
///
/// This is the same as `factors` over the full range with transient: the transient's columns are the transforms of the first n
/// unit vectors, and taking them out deletes exactly the n rows that wrap around. Both solutions agree to rounding, tau apart,
/// which has no meaning here. No transform is needed, so this is also the faster way to the full range.
/// Reference: M. J. Levin, IEEE Trans. Automatic Control 9 (1964) 229; Fernando & Nicholson 1985.
/// Errors: those of lines_of and of `factors`.
Expected<Factors> time_domain_factors(const Eigen::Ref<const Eigen::VectorXd>& input,
                                      const Eigen::Ref<const Eigen::VectorXd>& output, Eigen::Index order);

}  // namespace bodeflow::koopmans_levin
