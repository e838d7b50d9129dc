#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bodeflow/numerics/random.hpp"
#include "sanathanan_koerner/data.hpp"

namespace bodeflow::test {

using sanathanan_koerner::Data;

/// Rows of a table of tests/data/rational_fits, without its heading.
inline std::vector<std::vector<double>> table_of(const std::string& name) {
  std::ifstream file(std::string(BODEFLOW_TEST_DATA "/rational_fits/") + name);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream parts(line);
    std::vector<double> row;
    for (std::string part; std::getline(parts, part, ',');) row.push_back(std::stod(part));
    rows.push_back(row);
  }
  return rows;
}

inline Eigen::VectorXd geometric(double first, double last, Eigen::Index count) {
  Eigen::VectorXd w(count);
  for (Eigen::Index k = 0; k < count; ++k)
    w[k] = first * std::pow(last / first, static_cast<double>(k) / static_cast<double>(count - 1));
  return w;
}

/// Data with weights of 1.
inline Data data_of(const Eigen::VectorXd& omega, const Eigen::MatrixXcd& response) {
  return {omega, response, Eigen::MatrixXd::Ones(omega.size(), 1)};
}

/// The response of modes wn, zeta, b of each input, c of each output: sum of c b wn^2 / (wn^2 - w^2 + 2 j zeta wn w).
inline Data modal_data(const std::string& file, Eigen::Index inputs, Eigen::Index outputs, const Eigen::VectorXd& omega) {
  Eigen::MatrixXcd g = Eigen::MatrixXcd::Zero(omega.size(), inputs * outputs);
  for (const auto& row : table_of(file)) {
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      const std::complex<double> mode =
          row[0] * row[0] / std::complex<double>(row[0] * row[0] - omega[k] * omega[k], 2.0 * row[1] * row[0] * omega[k]);
      for (Eigen::Index j = 0; j < inputs; ++j)
        for (Eigen::Index i = 0; i < outputs; ++i)
          g(k, j * outputs + i) += row[static_cast<std::size_t>(2 + inputs + i)] * row[static_cast<std::size_t>(2 + j)] * mode;
    }
  }
  return data_of(omega, g);
}

/// Poles of the modes above the axis.
inline Eigen::VectorXcd modal_poles(const std::string& file) {
  const auto rows = table_of(file);
  Eigen::VectorXcd poles(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t n = 0; n < rows.size(); ++n)
    poles[static_cast<Eigen::Index>(n)] =
        rows[n][0] * std::complex<double>(-rows[n][1], std::sqrt(1.0 - rows[n][1] * rows[n][1]));
  return poles;
}

inline Data example_2() { return modal_data("ex2_system.csv", 3, 2, geometric(0.5, 600.0, 1200)); }

/// |found - truth| / |truth| over all lines and channels.
inline double relative_error(const Eigen::MatrixXcd& found, const Eigen::MatrixXcd& truth) {
  return (found - truth).norm() / truth.norm();
}

/// The largest distance from an expected pole to the nearest found one, over the size of the expected one.
inline double worst_match(const Eigen::VectorXcd& found, const Eigen::VectorXcd& expected) {
  double worst = 0.0;
  for (const std::complex<double> p : expected) worst = std::max(worst, (found.array() - p).abs().minCoeff() / std::abs(p));
  return worst;
}

/// Complex noise of standard deviation 1, E|n|^2 = 1.
inline std::complex<double> complex_normal(numerics::Random& random) {
  const double re = random.normal();
  return std::sqrt(0.5) * std::complex<double>(re, random.normal());
}

}  // namespace bodeflow::test
