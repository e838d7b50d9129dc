#pragma once

#include <Eigen/Core>
#include <vector>

#include "solution.hpp"

namespace bodeflow::koopmans_levin {

/// One order of a scan.
struct ScannedOrder {
  Eigen::Index order = 0;
  double noise = 0.0;  ///< lambda_u, unbiased
  double ratio = 0.0;  ///< of the two smallest generalised eigenvalues
};

struct OrderScan {
  std::vector<ScannedOrder> orders;
  Eigen::Index chosen = 0;  ///< 0: the noise still falls at the highest order tried
  double tolerance = 0.0;   ///< t: what a fall of the noise to the next order must exceed to count, relative
};

/// The lowest order from which the noise falls no further: lambda(n) <= (1 + t sqrt(m - n)) lambda(m) for all m > n of the scan.
///
/// At the true order lambda stops falling, and one order above it the two smallest eigenvalues come together: any common factor
/// 1 + c z in A and B fits. What remains of a fall there is the correlation between neighbouring equation errors by chance, of
/// standard deviation 1/sqrt(equations); t = 8 of these. A common factor of degree m - n finds more of it. So an order whose
/// share in the noise is below t is not found (a weak mode): the table is there to be looked at. Cost: one QR an order. Errors:
/// highest order below 2; those of `factors` and `solve`. The scan ends early where data without noise leave more than one model.
Expected<OrderScan> scan_orders(const Lines& lines, double ratio, Eigen::Index highest, bool transient = true);

}  // namespace bodeflow::koopmans_levin
