#pragma once

#include <Eigen/Core>

/// Products of large matrices with the vector unit that the processor has. Sums are taken in one order whatever it is: the bits
/// are the same on every machine. Sizes must fit, as in Eigen.
namespace bodeflow::numerics {

/// C += factor A B.
void add_product(Eigen::Ref<Eigen::MatrixXd> C, const Eigen::Ref<const Eigen::MatrixXd>& A,
                 const Eigen::Ref<const Eigen::MatrixXd>& B, double factor = 1.0);

/// A' B.
Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B);

/// A' x.
Eigen::VectorXd transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x);

/// x -= A y.
void subtract_product(Eigen::Ref<Eigen::VectorXd> x, const Eigen::Ref<const Eigen::MatrixXd>& A,
                      const Eigen::Ref<const Eigen::VectorXd>& y);

/// A -= x y'.
void subtract_outer(Eigen::Ref<Eigen::MatrixXd> A, const Eigen::Ref<const Eigen::VectorXd>& x,
                    const Eigen::Ref<const Eigen::VectorXd>& y);

}  // namespace bodeflow::numerics
