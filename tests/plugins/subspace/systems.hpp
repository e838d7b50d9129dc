#pragma once

#include <Eigen/Dense>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/pole_residue.hpp>
#include <bodeflow/numerics/random.hpp>
#include <complex>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "subspace/identification.hpp"

namespace bodeflow::test {

using Complex = std::complex<double>;

inline Eigen::VectorXd geometric(double first, double last, Eigen::Index count) {
  Eigen::VectorXd w(count);
  for (Eigen::Index k = 0; k < count; ++k)
    w[k] = first * std::pow(last / first, static_cast<double>(k) / static_cast<double>(count - 1));
  return w;
}

/// Lines of a response, with equal weights.
inline subspace::Lines lines_of(const Eigen::VectorXd& omega, const std::vector<Eigen::MatrixXcd>& G) {
  subspace::Lines lines{omega, Eigen::MatrixXcd(omega.size(), G.front().size()), G.front().rows(),
                        Eigen::VectorXd::Ones(omega.size())};
  for (Eigen::Index k = 0; k < omega.size(); ++k) lines.response.row(k) = G[static_cast<std::size_t>(k)].reshaped().transpose();
  return lines;
}

template <class System>
subspace::Lines lines_of(const System& system, const Eigen::VectorXd& omega) {
  return lines_of(omega, numerics::frequency_response(system, omega / (2.0 * std::numbers::pi)));
}

inline double relative(const Eigen::MatrixXcd& found, const Eigen::MatrixXcd& expected) {
  return (found - expected).norm() / expected.norm();
}

/// The largest distance of a pole to the nearest one found, over its size.
inline double pole_error(const Eigen::VectorXcd& found, const Eigen::VectorXcd& expected) {
  double worst = 0.0;
  for (const Complex& p : expected) worst = std::max(worst, (found.array() - p).abs().minCoeff() / std::abs(p));
  return worst;
}

/// Rows of numbers of a file of tests/data/rational_fits.
inline Eigen::MatrixXd table(const std::string& name) {
  std::ifstream file(BODEFLOW_TEST_DATA "/rational_fits/" + name);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || std::isalpha(static_cast<unsigned char>(line.front()))) continue;
    std::stringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.at(0).size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) m(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return m;
}

/// Example 2 of D. A. Jue as the reference file has it: each mode contributes c b' w^2 / (s^2 + 2 zeta w s + w^2).
inline numerics::PoleResidue example_2() {
  const Eigen::MatrixXd rows = table("ex2_system.csv");
  numerics::PoleResidue system;
  system.poles.resize(rows.rows());
  system.D = Eigen::MatrixXd::Zero(2, 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double w = rows(i, 0), zeta = rows(i, 1), damped = w * std::sqrt(1.0 - zeta * zeta);
    system.poles[i] = Complex(-zeta * w, damped);
    const Eigen::MatrixXcd strength = (rows.row(i).segment(5, 2).transpose() * rows.row(i).segment(2, 3)).cast<Complex>();
    system.residues.emplace_back(strength * (w * w / Complex(0.0, 2.0 * damped)));
  }
  return system;
}

}  // namespace bodeflow::test
