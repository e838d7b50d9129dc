#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "model_record.hpp"
#include "records/signals.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

using records::counted;
using records::short_number;
using Texts = std::vector<std::string>;

constexpr double kImprobable = 0.001;
constexpr double kFewEquations = 2.0;  // complex equations a real parameter
constexpr double kFewDegrees = 5.0;

std::string rounded(double value) { return short_number(value, 3); }

void warn_of_noise(const Identification& id, const Measured& measured, Texts& warnings) {
  if (!measured.known_variance) {
    if (measured.deviation.size() == 0)
      warnings.push_back(
          "the response has no variance: the residual can't be compared with the noise, and deviations come from "
          "the residuals; measure several periods");
    return;
  }
  if (measured.degrees_of_freedom < kFewDegrees)
    warnings.push_back("the variances have only " + short_number(measured.degrees_of_freedom) +
                       " degrees of freedom: lines weigh by chance; measure at least 6 periods");
  const double expected = static_cast<double>(id.equations) - 0.5 * static_cast<double>(id.parameters);
  if (!(expected > 0.0) || !(numerics::chi_squared_tail(2.0 * id.cost, 2.0 * expected) < kImprobable)) return;
  warnings.push_back("the residual is " + rounded(std::sqrt(id.cost / expected)) +
                     " times what the noise explains: raise the order, set `refine: true`, or the data hold what no linear model "
                     "has (see the record `residual`); standard deviations do not hold this error");
}

void warn_of_poles(const Identification& id, const Settings& settings, Texts& warnings) {
  if (id.reflected > 0 && !id.refinement)
    warnings.push_back(counted(id.reflected, "unstable pole") +
                       " of the last step reflected into the stable half: where the plant is stable, noise or an order too high "
                       "makes them; lower the order, or set `stability: off` to see them");
  Eigen::Index unstable = 0;
  for (const std::complex<double> p : id.poles) unstable += settings.sample_time_s > 0.0 ? std::abs(p) >= 1.0 : p.real() >= 0.0;
  if (unstable > 0)
    warnings.push_back(counted(unstable, "pole") + " of the model " + (unstable == 1 ? "is" : "are") + " not stable");
}

void warn_of_search(const Identification& id, Texts& warnings) {
  if (!id.course.converged && !id.course.reason.empty())
    warnings.push_back("the iteration has not settled (" + id.course.reason + "): the best iterate is kept");
  if (id.refinement && !id.refinement->converged) warnings.push_back("the refinement did not converge: " + id.refinement->reason);
  if (static_cast<double>(id.equations) < kFewEquations * 0.5 * static_cast<double>(id.parameters))
    warnings.push_back("few lines: " + counted(id.equations, "complex equation") + " for " +
                       counted(id.parameters, "real parameter") +
                       "; the model follows the noise: measure more lines, or lower the order");
  if (id.scan && id.scan->still_falls)
    warnings.push_back("the order proposed, " + std::to_string(id.order) +
                       ", is the highest tried: raise `highest_order`, or give the order (see `order_scan`)");
}

}  // namespace

std::vector<std::string> model_warnings(const Identification& id, const Measured& measured, const Settings& settings) {
  Texts warnings;
  warn_of_noise(id, measured, warnings);
  if (measured.correlated_lines > 0)
    warnings.push_back(
        "neighbouring lines share data: deviations are too small; take a response by whole periods, or "
        "maximum_likelihood.model");
  warn_of_poles(id, settings, warnings);
  warn_of_search(id, warnings);
  if (!id.no_covariance.empty()) warnings.push_back("the model has no covariance: " + id.no_covariance);
  return warnings;
}

}  // namespace bodeflow::sanathanan_koerner
