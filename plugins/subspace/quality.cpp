#include "quality.hpp"

#include <cmath>

namespace bodeflow::subspace {

Quality quality_of(const Lines& lines, const Eigen::MatrixXcd& response) {
  const Eigen::VectorXd error = (lines.response - response).rowwise().norm(), size = lines.response.rowwise().norm();
  return {error.maxCoeff(), error.norm() / std::sqrt(static_cast<double>(lines.size())), error.norm() / size.norm(),
          error.cwiseProduct(lines.weight).norm() / size.cwiseProduct(lines.weight).norm()};
}

}  // namespace bodeflow::subspace
