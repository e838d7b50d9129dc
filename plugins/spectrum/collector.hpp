#pragma once

#include <bodeflow/error.hpp>

#include "moments.hpp"

namespace bodeflow::spectrum {

/// Takes the periods of one experiment and gives its moments.
class Collector {
 public:
  virtual ~Collector() = default;
  /// Takes one period: N samples of all signals in columns, all finite.
  virtual void add(const Eigen::Ref<const Eigen::MatrixXd>& frame) = 0;
  /// The number of periods taken.
  virtual std::int64_t periods() const = 0;
  /// The moments of the periods so far. Errors: too few of them for the method.
  virtual Expected<Moments> moments() const = 0;
  /// Forgets all periods.
  virtual void clear() = 0;
};

}  // namespace bodeflow::spectrum
