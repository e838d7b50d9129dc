#pragma once

#include <optional>

#include "order_scan.hpp"

namespace bodeflow::subspace {

struct Settings {
  std::optional<Eigen::Index> order;      ///< nothing: by scan_orders
  Eigen::Index highest_order = 40;        ///< of that scan
  std::optional<Eigen::Index> functions;  ///< q; nothing: 40, or 20 more than the order, as far as the lines allow
  Basis basis = Basis::arnoldi;
  Stability stability = Stability::project;
  bool scan_prewarp = false;  ///< try others beside that of the plane, which is continuous in time
  int polish = 5;             ///< Sanathanan-Koerner iterations at the end; 0: none
};

struct Identification {
  Plane plane;  ///< with the pre-warp frequency that was best
  Eigen::Index functions = 0;
  Model model;
  Quality quality;
  Eigen::VectorXd singular_values;
  std::optional<OrderScan> scan;
  bool polished = false;
  Quality unpolished;  ///< of the subspace model itself
};

/// The pre-warp frequency of Akcay, Islam, Ninness: the highest frequency over pi (theirs is twice the bandwidth in hertz, taken
/// for rad/s).
double bandwidth_prewarp(const Eigen::VectorXd& omega_rad_s);

/// The model of the lines, by the subspace algorithm of H. Akcay, S. M. Islam, B. Ninness (1999) and what `Settings` adds to it.
/// repeated: another measurement for the order's validation, with weights as those of `lines`. Errors: those of its parts.
Expected<Identification> identify(const Lines& lines, const Plane& plane, const Settings& settings,
                                  const std::optional<Lines>& repeated = {});

}  // namespace bodeflow::subspace
