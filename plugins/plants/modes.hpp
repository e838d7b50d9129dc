#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/linear_system.hpp>
#include <string>

namespace bodeflow::plants {

/// A structure by its modes: G = sum of c_i b_j w^2 / (s^2 + 2 zeta w s + w^2) from input j to output i.
struct Modes {
  Eigen::VectorXd omega_rad_s, damping;
  Eigen::MatrixXd inputs;   ///< b: modes x inputs
  Eigen::MatrixXd outputs;  ///< c: modes x outputs
};

/// The modes in a table with the heading wn,zeta,b...,c...: rad/s, ratio, gains of each input (b, or b1, b2 ...) and output.
/// Errors, with the line: another heading, rows of another length, values that are no numbers, no modes.
numerics::Expected<Modes> read_modes(const std::string& text);

/// The structure as a state space of two states a mode, in balanced scale (w q and dq/dt are alike in size). Errors: frequencies
/// or damping ratios that are not above 0, sizes that do not fit.
numerics::Expected<numerics::StateSpace> modal_system(const Modes& modes);

}  // namespace bodeflow::plants
