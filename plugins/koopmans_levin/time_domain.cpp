#include "time_domain.hpp"

#include <algorithm>
#include <cmath>

#include "growing_triangle.hpp"

namespace bodeflow::koopmans_levin {

namespace {
constexpr Eigen::Index kBlockRows = 1024;
}

Expected<Factors> time_domain_factors(const Eigen::Ref<const Eigen::VectorXd>& input,
                                      const Eigen::Ref<const Eigen::VectorXd>& output, Eigen::Index order) {
  if (auto fine = check_records(input, output); !fine) return tl::make_unexpected(fine.error());
  if (auto fine = check_order(order, true, input.size()); !fine) return tl::make_unexpected(fine.error());
  const Eigen::Index rows = input.size() - order, powers = order + 1;
  GrowingTriangle triangle(2 * powers, kBlockRows);
  const double scale = 1.0 / std::sqrt(static_cast<double>(input.size()));
  for (Eigen::Index first = 0; first < rows; first += kBlockRows) {
    const Eigen::Index count = std::min(kBlockRows, rows - first);
    auto block = triangle.rows(count);
    for (Eigen::Index j = 0; j < powers; ++j) {
      block.col(j) = scale * output.segment(first + j, count);
      block.col(powers + j) = scale * input.segment(first + j, count);
    }
    triangle.append(count);
  }
  Factors f;
  f.order = order;
  f.data = triangle.triangle();
  f.noise = Eigen::MatrixXd::Identity(powers, powers);
  f.equations = input.size();
  f.free_parameters = 3 * order + 1;  // the n rows left out count as n parameters: the scale stays 1/N
  return f;
}

}  // namespace bodeflow::koopmans_levin
