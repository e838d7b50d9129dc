#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <complex>
#include <vector>

namespace bodeflow::sanathanan_koerner {

/// Poles of a real system in continuous time: of each conjugate pair the one above the axis, and the real ones.
struct PoleSet {
  std::vector<std::complex<double>> pairs;
  std::vector<double> real;

  Eigen::Index order() const { return static_cast<Eigen::Index>(2 * pairs.size() + real.size()); }
};

/// Poles with those of the lower half plane left out. Errors: a complex pole without its conjugate.
Expected<PoleSet> pole_set(const Eigen::VectorXcd& poles);

/// All poles, each pair one after the other.
Eigen::VectorXcd all_poles(const PoleSet& poles);

/// Responses sum over the poles of R / (s - p) + D, as real coefficients: of a pair x / (s - p) + x / (s - p*) and
/// j y / (s - p) - j y / (s - p*), so that R = x + j y.
struct PartialFractions {
  PoleSet poles;
  Eigen::MatrixXd coefficients;  ///< order + 1 x channels: x, y of each pair, then the residues of real poles, then D

  Eigen::Index channels() const { return coefficients.cols(); }
};

/// The functions that the coefficients multiply, at the lines: lines x order + 1, the last one 1.
Eigen::MatrixXcd partial_fractions_at(const PoleSet& poles, const Eigen::VectorXd& omega_rad_s);

Eigen::MatrixXcd response(const PartialFractions& model, const Eigen::VectorXd& omega_rad_s);

/// R of each pole of all_poles: order x channels.
Eigen::MatrixXcd residues(const PartialFractions& model);

/// The realisation with one input in real modal form: a block (re, im; -im, re) with input (2, 0) for each pair.
numerics::StateSpace state_space(const PartialFractions& model);

/// The matrices A and b of that realisation.
struct ModalPair {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};
ModalPair modal_pair(const PoleSet& poles);

}  // namespace bodeflow::sanathanan_koerner
