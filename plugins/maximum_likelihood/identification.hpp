#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis.hpp"
#include "order_scan.hpp"

namespace bodeflow::maximum_likelihood {

/// How lines weigh: by the variance of the data, all alike in G, or all alike relative to |G|.
enum class Weighting { variance, even, relative };

/// What is asked of an identification.
struct Settings {
  Domain domain = Domain::s;
  std::optional<Eigen::Index> order;  ///< nothing: the lowest that suffices
  Eigen::Index highest_order = 8;
  /// One an output, or one for all, or none (order - 1 of s, the order of z; less where the delay is estimated and less is
  /// enough); below 0: relative to the order.
  std::vector<Eigen::Index> numerator_orders;
  bool estimate_delay = false;
  double delay_s = 0.0;
  std::optional<std::pair<double, double>> delay_range_s;  ///< nothing: see widest_delay
  Eigen::VectorXcd fixed_poles;
  std::vector<FixedCoefficient> fixed;
  Weighting weighting = Weighting::variance;
  bool zero_order_hold = false;
  int starts = 6;
};

/// A model with all that is known about it.
struct Identification {
  Spectra spectra;  ///< of the lines that were fitted, weighted as they were
  Fit fit;
  std::optional<OrderScan> scan;
  /// With a delay that is estimated: a numerator of one order less, with which the cost rises no more than by chance. Data then
  /// hardly tell its highest coefficient from the delay.
  std::optional<std::vector<Eigen::Index>> enough_numerator_orders;
  bool variance_known = true;
  CostTest test;  ///< meaningful where variance_known
  Criteria criteria;
  CovarianceKind covariance_kind = CovarianceKind::information;
  Eigen::MatrixXd covariance_root;                  ///< empty where there is none
  std::string no_covariance;                        ///< why
  std::vector<std::optional<Whiteness>> whiteness;  ///< one an output
};

/// The structure that the settings ask for at an order.
Structure structure_for(const Settings& settings, const Spectra& spectra, Eigen::Index order);

/// The model of `spectra` (those of the band). Where the delay is estimated and no numerator order is given, that is the lowest
/// which no higher one undercuts significantly: a zero far above the band and a delay are nearly the same, b1 s + b0 ~ b0 exp(s
/// b1/b0). The covariance is that of the Fisher information for one output whose cost is as
/// expected (probability at least 1 %), else that of the residuals. Errors: those of fit_model.
Expected<Identification> identify(const Spectra& spectra, const Settings& settings);

}  // namespace bodeflow::maximum_likelihood
