#include "bodeflow/numerics/chi_squared.hpp"

#include <boost/math/special_functions/gamma.hpp>

namespace bodeflow::numerics {

namespace {

using namespace boost::math::policies;
// An overflow gives infinity, an underflow 0; nothing throws.
using Quiet = policy<domain_error<ignore_error>, overflow_error<ignore_error>, underflow_error<ignore_error>,
                     evaluation_error<ignore_error>, promote_double<false>>;

}  // namespace

double chi_squared_tail(double value, double degrees_of_freedom) {
  return value > 0.0 ? boost::math::gamma_q(0.5 * degrees_of_freedom, 0.5 * value, Quiet()) : 1.0;
}

double chi_squared_limit(double probability, double degrees_of_freedom) {
  return 2.0 * boost::math::gamma_q_inv(0.5 * degrees_of_freedom, probability, Quiet());
}

}  // namespace bodeflow::numerics
