#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "fit.hpp"

namespace bodeflow::sanathanan_koerner {

/// Data as the iteration has them: weights of mean square 1.
struct ScaledData {
  Data data;
  Eigen::VectorXd shared;  ///< weights that all channels are given first
  double norm = 0.0;       ///< weighted norm
};

ScaledData scaled_data(const Data& data);

/// The Sanathanan-Koerner iteration of `fit`, one iterate after the other.
class Iteration {
 public:
  struct Weighted;

  /// data must pass check and check_order and outlive this. start: d_before of the first step at the lines; empty: 1.
  Iteration(const ScaledData& data, const Plane& plane, const FitSettings& settings, const Eigen::VectorXcd& start = {});
  Iteration(Iteration&&) noexcept;
  Iteration& operator=(Iteration&&) noexcept;
  ~Iteration();

  /// Makes the next iterate and judges it; false: this was the last one, or there is none.
  bool advance();
  const Course& course() const { return course_; }

  /// The best iterate. Errors: none is finite.
  Expected<Fit> result() &&;

 private:
  bool end(const std::string& why);

  const ScaledData* data_;
  Plane plane_;
  FitSettings settings_;
  Eigen::VectorXcd z_, denominator_;
  std::unique_ptr<Weighted> weighted_;  ///< in the weights of the denominator so far, where it is known already
  Fit best_;
  Course course_;
};

}  // namespace bodeflow::sanathanan_koerner
