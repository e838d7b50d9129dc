#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "order_scan.hpp"
#include "ratio_sensitivity.hpp"
#include "unknown_ratio.hpp"
#include "whiteness.hpp"

namespace bodeflow::koopmans_levin {

/// Where the equations are solved: both give the same numbers over the full range.
enum class Route { frequency_domain, time_domain };

/// How a model is wanted.
struct Settings {
  std::optional<Eigen::Index> order;     ///< nothing: by a scan
  Eigen::Index highest_order = 8;        ///< of the scan; fewer where the lines do not allow them
  std::optional<double> ratio;           ///< output noise variance / input noise variance; nothing: estimated
  std::optional<double> output_noise;    ///< its variance, measured elsewhere
  double output_noise_std = 0.0;         ///< standard deviation of that variance
  std::optional<Band> noise_band;        ///< lines where the output holds noise only
  std::optional<Eigen::Index> lags;      ///< of covariance matching
  std::optional<double> fallback_ratio;  ///< taken where the data do not determine the ratio
  std::optional<Band> band;              ///< nothing: the full range
  bool transient = true;
  bool refine = false;  ///< by maximum likelihood
  NoiseMatrix noise_matrix = NoiseMatrix::exact;
  Route route = Route::frequency_domain;
};

/// Where the ratio came from.
enum class RatioSource { declared, covariance_matching, output_noise, noise_band, fallback };

/// "declared", "covariance_matching", ...
std::string name_of(RatioSource source);

/// A model with all that tells how far to trust it.
struct Identification {
  Lines lines;
  Model model;
  Eigen::Index free_parameters = 0;  ///< a, b and the transient
  bool noise_free = false;           ///< the equations hold to rounding
  /// Of a_1 .. a_n, b_0 .. b_n. An estimated ratio adds its uncertainty. Empty with the identity as noise matrix of a band.
  Eigen::MatrixXd covariance;
  double noise_std = 0.0;  ///< of lambda_u; NaN where it is not known

  RatioSource ratio_source = RatioSource::declared;
  std::optional<RatioEstimate> estimate;        ///< where the ratio was not declared, determined or not
  std::optional<OrderScan> scan;                ///< where the order was not given
  std::optional<RatioSensitivity> sensitivity;  ///< where the ratio is not estimated and a covariance is known
  std::optional<Whiteness> whiteness;           ///< where there are lines enough and noise
  std::optional<std::string> refinement;        ///< why the search for the maximum ended without converging
};

/// The model of two records, by the methods of this folder in their order: lines, order, ratio, solution, refinement, checks.
///
/// Refined with an estimated ratio, the covariance adds what one standard deviation
/// of ln(ratio) moves the refined model by.
/// Errors: those of the methods; a ratio that is not determined, without a fallback; time domain with a band or without
/// transient; refinement without transient.
Expected<Identification> identify(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::VectorXd>& output,
                                  const Settings& settings);

}  // namespace bodeflow::koopmans_levin
