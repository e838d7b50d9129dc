#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "expected.hpp"

namespace bodeflow::maximum_likelihood {

enum class Domain { s, z };

/// A coefficient that keeps a value: a_power of the denominator, whose highest coefficient is 1, or b_power of the numerator of
/// one output; powers of s in rad/s, or of z.
struct FixedCoefficient {
  bool of_denominator = true;
  Eigen::Index output = 0;
  Eigen::Index power = 0;
  double value = 0.0;
};

/// The model that is fitted: G_i = B_i(x) / A(x) exp(-s delay), x = s or z = exp(s sample_time), for each output i.
struct Structure {
  Domain domain = Domain::s;
  Eigen::Index order = 1;                      ///< of A, fixed poles included
  std::vector<Eigen::Index> numerator_orders;  ///< one an output
  bool estimate_delay = false;
  double delay_s = 0.0;                          ///< where it is not estimated
  double delay_low_s = 0.0, delay_high_s = 0.0;  ///< where it is
  Eigen::VectorXcd fixed_poles;                  ///< in rad/s or as values of z, conjugates included
  std::vector<FixedCoefficient> fixed;
  /// The input is constant between the samples, and input and output are the samples: the model of domain s is fitted through its
  /// exact equivalent at the sample times.
  bool zero_order_hold = false;

  Eigen::Index free_poles() const { return order - fixed_poles.size(); }
  /// How many real numbers are estimated.
  Eigen::Index parameters() const;
};

/// "a0", "b2"; with several outputs b of output 2 as "b2_out2".
std::string name_of(const FixedCoefficient& coefficient, std::size_t outputs);

/// Nothing, or why there is no such model: more fixed poles than the order, fixed coefficients that it does not have, orders out
/// of 0 .. 30, a numerator that does not fit the domain or the hold, a delay that is not finite.
Expected<void> check(const Structure& structure, Eigen::Index outputs, double sample_time_s);

}  // namespace bodeflow::maximum_likelihood
