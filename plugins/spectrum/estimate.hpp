#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <cstdint>
#include <vector>

#include "lines.hpp"
#include "moments.hpp"

namespace bodeflow::spectrum {

/// What is taken as exact: the mean input spectrum; neither signal; or a reference signal r that causes both.
enum class Form { known_input, errors_in_variables, reference };

/// A frequency response at some lines of the period, with what it was made from. Rows: lines. Columns: outputs, or output i and
/// input j in column i * inputs + j.
struct Estimate {
  std::vector<std::int64_t> lines;     ///< k; its frequency is k / N times the sample rate
  std::int64_t periods = 0;            ///< P of one experiment (the smallest where they differ)
  std::int64_t realisations = 1;       ///< M
  Eigen::MatrixXcd response;           ///< G_ij(k)
  Eigen::MatrixXd variance;            ///< of G_ij(k), complex: E|dG|^2
  Eigen::MatrixXd degrees_of_freedom;  ///< of `variance`, complex ones
  Eigen::MatrixXd noise_variance;      ///< M > 1 and P > 1: the part of `variance` that is noise
  Eigen::MatrixXd nonlinear_variance;  ///< likewise: variance of the stochastic nonlinear contribution of one realisation
  Eigen::VectorXd condition;           ///< of the inputs of all experiments; largest of the realisations
  Eigen::MatrixXd noise_level;         ///< lines x outputs: standard deviation of the mean output of an experiment, rms over all
  // One input, one experiment, one realisation only:
  Eigen::VectorXcd input_mean;        ///< U(k), unit of the input
  Eigen::VectorXd input_variance;     ///< of U(k), unit of the input squared
  Eigen::MatrixXcd output_mean;       ///< Y_i(k), unit of the output
  Eigen::MatrixXd output_variance;    ///< of Y_i(k)
  Eigen::MatrixXcd cross_covariance;  ///< of Y_i(k) and U(k): E{dY conj(dU)}
};

/// The response from the moments of M realisations of E experiments.
///
/// One realisation: U (inputs x experiments), Y (outputs x experiments) of the mean spectra, R likewise of the references.
///   errors_in_variables, known_input: W = U^-1 (least squares, U^H (U U^H)^-1, for more experiments than inputs);
///   reference: T = [U; Y] R^H (R R^H)^-1, W = R^H (R R^H)^-1 T_u^-1: G = S_yr S_ur^-1 of the spectral matrices of the means.
///   G = Y W,  to first order dG = (dY - G dU) W  (known_input: dU = 0), so with C_e the covariances of experiment e
///   var G_ij = sum_e |W_ej|^2 [-G_i 1] C_e [-G_i 1]^H.
/// For one input that is |G|^2 (var_y/|Y|^2 + var_u/|U|^2 - 2 Re(cov_yu / (Y conj U))), written so that it is defined for Y = 0.
/// Degrees of freedom: (sum_e |W_ej|^2)^2 / sum_e (|W_ej|^4 / nu_e), after Satterthwaite, for noise alike in the experiments: E
/// (P - 1) for orthogonal ones, P - 1 where each drives one input.
///
/// M > 1 realisations, the robust method: each has other phases, so nonlinear distortion scatters between them as well. G is the
/// mean of the G^m (best linear approximation), `variance` its scatter 1/(M(M-1)) sum_m |G^m - G|^2 with M - 1 degrees,
/// `noise_variance` 1/M^2 sum_m var G^m, `nonlinear_variance` M (variance - noise_variance), at least 0, hence biased upward
/// where noise dominates, in its mean over lines as well; M (mean variance - mean noise_variance) is not. With a reference the
/// T^m are averaged before G = T_y T_u^-1: what the input holds of distortion then averages out.
///
/// Assumptions: |U| well above its own deviation: G = Y/U is biased by about -G exp(-|U|^2/var_u), below 5e-5 of G from 10 dB on,
/// and has no finite variance where U can come near zero. Without `reference` a loop around a weak excitation biases G.
/// Reference: R. Pintelon, J. Schoukens, System Identification, 2nd ed. 2012, sections 2.4 to 2.7 and 4.3; F. E. Satterthwaite,
/// Biometrics Bull. 2 (1946) 110, doi:10.2307/3002019.
///
/// Errors: no line excited; a line without input (below 1e-12 of the strongest line: rounding of the transform), or whose
/// experiments do not tell the inputs apart; a single realisation of a single period; overflow.
Expected<Estimate> estimate_response(const Measured& measured, const LineChoice& choice, Form form);

}  // namespace bodeflow::spectrum
