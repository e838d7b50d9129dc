#pragma once

#include <vector>

#include "trace/coordinates.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// The residuals of a joint model on several records below each other, over the coordinates of a fit. Refers to its arguments,
/// which have to outlive it.
class FitProblem {
 public:
  /// The first `settled` parameters of the model are about right already: those of the base, where nothing is said.
  FitProblem(const JointModel& model, const Measurements& records, Eigen::Index settled = -1);

  const JointModel& model() const { return model_; }
  const Measurements& records() const { return records_; }
  const Coordinates& layout() const { return layout_; }
  Eigen::Index rows() const { return rows_; }
  /// Where a record's rows begin.
  Eigen::Index begin_of(std::size_t record) const { return begin_[record]; }

  /// Positive parameters of the base that end beyond 30 times, or below 1/30 of, these coordinates are outside of the domain: a
  /// wrong model can pull them away without end.
  void bound_base(const Eigen::VectorXd& coordinates) { bounds_ = coordinates; }

  /// The coordinates with those of the base that are not logarithmic moved into the bounds that physics sets them: a parameter
  /// that an effect makes needless rests there, and does not stop the others.
  Eigen::VectorXd within_bounds(Eigen::VectorXd coordinates) const;

  /// At `within_bounds(coordinates)`. Not finite outside of the domain.
  Eigen::VectorXd residual(const Eigen::VectorXd& coordinates) const;
  /// The column of the Jacobian of coordinate `i`; `here` is the residual at `coordinates`. By forward differences, backward ones
  /// at the border of the domain; not finite where neither is inside.
  Eigen::VectorXd column(Eigen::Index i, const Eigen::VectorXd& coordinates, const Eigen::VectorXd& here) const;
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& coordinates, const Eigen::VectorXd& here) const;
  bool is_settled(Eigen::Index i) const { return settled_[static_cast<std::size_t>(i)]; }

 private:
  bool inside(const Eigen::VectorXd& coordinates) const;
  Eigen::VectorXd difference(Eigen::Index i, double step, const Eigen::VectorXd& coordinates, const Eigen::VectorXd& here) const;

  const JointModel& model_;
  const Measurements& records_;
  Coordinates layout_;
  std::vector<Eigen::Index> begin_;
  std::vector<bool> settled_;
  Eigen::VectorXd bounds_;
  Eigen::Index rows_ = 0;
  double step_ = 1e-5;  ///< of differences
};

/// (J^T J)^-1 over the directions that the data determine: a direction with less than 1e-12 of the greatest information, in
/// columns of unit length, is left out. Zero without rows.
Eigen::MatrixXd pseudo_inverse_normal(const Eigen::MatrixXd& jacobian);

}  // namespace bodeflow::residual
