#include "influence.hpp"

#include <complex>

#include "powers.hpp"

namespace bodeflow::koopmans_levin {

Influence::Influence(const Lines& lines, const Factors& factors, const Solution& solution) : lines_(lines), solution_(solution) {
  const Eigen::Index q = solution.x.size(), one = factors.order;
  if (factors.has_transient()) {
    transient_from_x_ = factors.transient.triangularView<Eigen::Upper>().solve(factors.coupling);
  }
  const Eigen::MatrixXd others = solution.basis.leftCols(q - 1);
  const Eigen::VectorXd gaps = solution.squares.head(q - 1).array() - solution.noise;
  change_from_share_ = -others * gaps.cwiseInverse().asDiagonal() * others.transpose();
  change_from_share_ -= solution.x * change_from_share_.row(one).eval();  // A keeps its 1
  // The last basis vector has x^T Lambda x = 1 before x is scaled.
  const double scale = solution.basis(one, q - 1);
  noise_from_share_ = solution.x.transpose() * scale * scale;
}

Expected<Influence> Influence::of(const Lines& lines, const Factors& factors, const Solution& solution) {
  if (solution.noise_matrix == NoiseMatrix::identity && !lines.is_full_range()) {
    return refused("with the identity as noise matrix of a band the estimate has a bias and no covariance is right");
  }
  return Influence(lines, factors, solution);
}

void Influence::for_each(const std::function<void(Eigen::Index, const Line&)>& visit) const {
  const Eigen::Index n = solution_.order(), powers = n + 1, q = 2 * powers;
  const Eigen::VectorXd xa = solution_.x.head(powers), xb = solution_.x.tail(powers);
  const double total = lines_.total_weight();
  Line line;
  line.powers.resize(powers);
  line.row.resize(q);
  line.change.resize(q + 1);
  Eigen::VectorXd share(q);
  for (Eigen::Index k = 0; k < lines_.size(); ++k) {
    fill_powers(lines_.omega(k), line.powers);
    line.A = (line.powers.transpose() * xa).value();
    line.B = -(line.powers.transpose() * xb).value();
    line.row << lines_.output[k] * line.powers, lines_.input[k] * line.powers;
    if (transient_from_x_.rows() > 0) line.row -= transient_from_x_.transpose() * line.powers.tail(n);
    line.error = (line.row.transpose() * solution_.x).value();
    line.variance = solution_.noise * (solution_.ratio * std::norm(line.A) + std::norm(line.B));
    share = (line.row.conjugate() * line.error).real();
    share.head(powers) -= solution_.noise * solution_.ratio * (line.powers.conjugate() * line.A).real();
    share.tail(powers) += solution_.noise * (line.powers.conjugate() * line.B).real();
    share *= lines_.weight[k] / total;
    line.change.head(q) = change_from_share_ * share;
    line.change[q] = noise_from_share_ * share;
    visit(k, line);
  }
}

Eigen::VectorXd in_parameter_order(const Eigen::VectorXd& change) {
  const Eigen::Index n = (change.size() - 3) / 2;
  Eigen::VectorXd ordered(2 * n + 2);
  ordered << change.head(n).reverse(), -change.segment(n + 1, n + 1).reverse(), change[2 * n + 2];
  return ordered;
}

Expected<Eigen::MatrixXd> covariance(const Lines& lines, const Factors& factors, const Solution& solution) {
  const auto influence = Influence::of(lines, factors, solution);
  if (!influence) return tl::make_unexpected(influence.error());
  const Eigen::Index size = 2 * solution.order() + 2;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  influence->for_each([&](Eigen::Index, const Influence::Line& line) {
    sum.selfadjointView<Eigen::Lower>().rankUpdate(in_parameter_order(line.change));
  });
  return Eigen::MatrixXd(sum.selfadjointView<Eigen::Lower>());
}

}  // namespace bodeflow::koopmans_levin
