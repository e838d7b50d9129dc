#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {

/// G(x) = D + sum_i M_i / (x - p_i), with simple poles in rad/s (continuous) or as values of z (discrete). Of each conjugate pair
/// only the member with positive imaginary part is listed; the other one has the conjugate residue.
struct PoleResidue {
  Eigen::VectorXcd poles;                  ///< imaginary parts are not negative
  std::vector<Eigen::MatrixXcd> residues;  ///< M_i, outputs x inputs, one a pole; real for a real pole
  Eigen::MatrixXd D;
  double sample_time = 0.0;
};

/// The poles of a list whose imaginary parts are not negative, those of pairs first. Errors: those of `split_roots`.
Expected<Eigen::VectorXcd> upper_poles(const Eigen::VectorXcd& all);

/// All poles: each pair as p, conj(p) one after the other.
Eigen::VectorXcd all_poles(const PoleResidue& system);

/// G at each frequency [Hz]: one outputs x inputs matrix a line.
std::vector<Eigen::MatrixXcd> frequency_response(const PoleResidue& system, const Eigen::VectorXd& frequency_hz);

/// The residues and the D that fit `response` (one outputs x inputs matrix a line) best with the given poles (imaginary parts not
/// negative), in least squares with the lines' real weights (empty: 1). Method: real columns 1/(x-p) + 1/(x-conj p) and
/// j/(x-p) - j/(x-conj p), scaled to equal norm; one column-pivoted QR factorisation for all entries. Residues so found reach
/// working precision where those from eigenvectors of a realisation lose the eigenvectors' condition.
/// Cost: O(lines * poles * (poles + entries)). Errors: sizes that do not fit, values that are not finite, fewer equations than
/// unknowns, a pole on a line of the response.
Expected<PoleResidue> residues_by_least_squares(const Eigen::VectorXcd& poles, const Eigen::VectorXd& frequency_hz,
                                                const std::vector<Eigen::MatrixXcd>& response, const Eigen::VectorXd& weight,
                                                double sample_time = 0.0);

/// Poles and residues of a state-space system, from its eigenvectors: their condition number multiplies the rounding error.
/// Errors: a pole that is not simple within the eigenvectors' accuracy (condition above 1e12), entries that are not finite.
Expected<PoleResidue> to_pole_residue(const StateSpace& system);

/// Poles and residues of a transfer function. Errors: those of `roots`, an improper one, poles that are not simple.
Expected<PoleResidue> to_pole_residue(const TransferFunction& system);

/// A minimal realisation in real modal form (Gilbert, "Controllability and observability in multivariable control systems", SIAM
/// J. Control 1, 1963): each residue M = L R by its singular values above `tolerance` times its largest one, L = U sqrt(S),
/// R = sqrt(S) V^*; the pair p, conj(p) with residues M, conj(M) becomes rank(M) blocks [re p, -im p; im p, re p] with input rows
/// [re R; im R] and output columns [2 re L, -2 im L], a real pole rank(M) single states. D is kept. A pole with the residue 0 has
/// no state. `tolerance`: 0 <= tolerance < 1. Errors: sizes that do not fit, values that are not finite, a negative imaginary
/// part.
Expected<StateSpace> gilbert_realisation(const PoleResidue& system, double tolerance = 1e-12);

/// The same system in real modal form: A has blocks [re p, im p; -im p, re p] of pairs and single real poles. Errors: those of
/// to_pole_residue.
Expected<StateSpace> modal_form(const StateSpace& system);

}  // namespace bodeflow::numerics
