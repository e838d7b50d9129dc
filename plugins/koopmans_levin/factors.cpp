#include "factors.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <complex>
#include <string>

#include "growing_triangle.hpp"
#include "line_sums.hpp"
#include "powers.hpp"

namespace bodeflow::koopmans_levin {

namespace {

using Complex = std::complex<double>;

constexpr Eigen::Index kHighestOrder = 64;
constexpr Eigen::Index kBlockLines = 512;
constexpr Eigen::Index kManyLines = 20'000;
// Below this ratio of squared pivots the product of the data matrix with itself has lost the digits that a solution needs.
constexpr double kLeastPivot = 1e-8;

Factors split(const Eigen::MatrixXd& r, Eigen::Index order, bool transient, Eigen::Index equations) {
  Factors f;
  f.order = order;
  f.equations = equations;
  f.free_parameters = (transient ? 3 : 2) * order + 1;
  const Eigen::Index t = transient ? order : 0, q = 2 * order + 2;
  f.transient = r.topLeftCorner(t, t);
  f.coupling = r.topRightCorner(t, q);
  f.data = r.bottomRightCorner(q, q);
  return f;
}

// Real and imaginary parts of the powers z^n .. 1 at one line, each times a factor, into two rows.
template <class Powers, class Row>
void write_powers(const Powers& powers, Complex factor, Row&& real, Row&& imaginary) {
  for (Eigen::Index i = 0; i < powers.size(); ++i) {
    const Complex scaled = factor * powers[i];
    real[i] = scaled.real();
    imaginary[i] = scaled.imag();
  }
}

}  // namespace

Expected<void> check_order(Eigen::Index order, bool transient, Eigen::Index equations) {
  if (order < 1 || order > kHighestOrder) {
    return refused("order " + std::to_string(order) + " is not within 1 .. " + std::to_string(kHighestOrder));
  }
  const Eigen::Index needed = (transient ? 3 : 2) * order + 2;
  if (equations < needed) {
    return refused("order " + std::to_string(order) + " needs at least " + std::to_string(needed) +
                   " real equations (2 a line, 1 at zero frequency); the band has " + std::to_string(equations));
  }
  return {};
}

Expected<Factors> factors(const Lines& lines, Eigen::Index order, bool transient) {
  const Eigen::Index equations = lines.equations();
  if (auto fine = check_order(order, transient, equations); !fine) return tl::make_unexpected(fine.error());
  const Eigen::Index n = order, t = transient ? n : 0, powers = n + 1;
  GrowingTriangle data(t + 2 * powers, 2 * kBlockLines), noise(powers, 2 * kBlockLines);
  const double scale = 1.0 / std::sqrt(lines.total_weight());
  Eigen::VectorXcd z(powers);
  for (Eigen::Index first = 0; first < lines.size(); first += kBlockLines) {
    const Eigen::Index count = std::min(kBlockLines, lines.size() - first);
    auto rows = data.rows(2 * count);
    auto plain = noise.rows(2 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index line = first + i;
      fill_powers(lines.omega(line), z);
      const double root = scale * std::sqrt(lines.weight[line]);
      if (transient) write_powers(z.tail(n), root, rows.row(2 * i).head(n), rows.row(2 * i + 1).head(n));
      write_powers(z, root * lines.output[line], rows.row(2 * i).segment(t, powers), rows.row(2 * i + 1).segment(t, powers));
      write_powers(z, root * lines.input[line], rows.row(2 * i).tail(powers), rows.row(2 * i + 1).tail(powers));
      write_powers(z, root, plain.row(2 * i).head(powers), plain.row(2 * i + 1).head(powers));
    }
    data.append(2 * count);
    if (!lines.is_full_range()) noise.append(2 * count);
  }
  Factors f = split(data.triangle(), order, transient, equations);
  f.noise = lines.is_full_range() ? Eigen::MatrixXd::Identity(powers, powers) : noise.triangle();
  return f;
}

Expected<Factors> factors_from_sums(const Lines& lines, Eigen::Index order, bool transient) {
  if (!lines.is_full_range()) return refused("sums over lines are exact enough for the full range only");
  const Eigen::Index equations = lines.equations();
  if (auto fine = check_order(order, transient, equations); !fine) return tl::make_unexpected(fine.error());
  const Eigen::MatrixXd sigma = line_sums(lines, order).normal_matrix(transient);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(sigma);
  const Eigen::MatrixXd r = cholesky.matrixU();
  const Eigen::VectorXd pivots = r.diagonal().cwiseAbs2().cwiseQuotient(sigma.diagonal());
  if (cholesky.info() != Eigen::Success || !(pivots.minCoeff() > kLeastPivot)) {
    return refused("the columns of the data are too nearly dependent for sums over lines");
  }
  Factors f = split(r, order, transient, equations);
  f.noise = Eigen::MatrixXd::Identity(order + 1, order + 1);
  return f;
}

Expected<Factors> quick_factors(const Lines& lines, Eigen::Index order, bool transient) {
  if (lines.size() > kManyLines && lines.is_full_range()) {
    if (auto f = factors_from_sums(lines, order, transient)) return f;
  }
  return factors(lines, order, transient);
}

}  // namespace bodeflow::koopmans_levin
