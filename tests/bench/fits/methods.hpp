#pragma once

#include <bodeflow/numerics/linear_system.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sanathanan_koerner/data.hpp"

namespace bench {

struct Model {
  bodeflow::numerics::StateSpace system;
  Eigen::VectorXcd poles;
};

/// A model of so many poles (a state for each and each port); nothing where there is none.
struct Method {
  std::string name;
  std::function<std::optional<Model>(const bodeflow::sanathanan_koerner::Data&, Eigen::Index ports, Eigen::Index order)> fit;
};

/// bodeflow's methods; in their default tuning where the name says no other.
std::vector<Method> methods();

/// Magnitudes of the errors over lines and entries.
Eigen::MatrixXd errors(const bodeflow::sanathanan_koerner::Data& data, const bodeflow::numerics::StateSpace& system);

}  // namespace bench
