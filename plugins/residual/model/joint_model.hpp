#pragma once

#include <Eigen/Core>
#include <bodeflow/base_model.hpp>
#include <bodeflow/effect.hpp>
#include <memory>
#include <string>
#include <vector>

#include "expected.hpp"

namespace bodeflow::residual {

/// An effect of the catalogue.
struct CatalogueEntry {
  EffectDescription what;
  std::shared_ptr<const Effect> effect;
};
using Catalogue = std::vector<CatalogueEntry>;

/// An effect bound to the spot where it acts.
struct Addition {
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);

  EffectDescription what;
  std::shared_ptr<const Effect> effect;
  std::size_t place = kNoPlace;  ///< of the base model, for laws and immittances
  Situation situation;           ///< what it was bound in
  std::vector<FitParameter> parameters;

  /// "coulomb_friction"
  std::string name() const { return what.name(); }
  /// "coulomb_friction at load_bearing" where the base has several places of its kinds, else the name.
  std::string label;
};

/// A base model with effects, their parameters joined in one vector: those of the base first, then those of each effect in the
/// order of `additions`.
struct JointModel {
  std::shared_ptr<const BaseModel> base;
  std::vector<Addition> additions;

  std::vector<FitParameter> parameters() const;
  Eigen::Index base_count() const;
  /// Where the parameters of addition `a` begin.
  Eigen::Index begin_of(std::size_t a) const;
  const double* values_of(std::size_t a, const Eigen::VectorXd& values) const { return values.data() + begin_of(a); }

  bool has(Acts acts) const;
  /// Known in closed form: no law, no map of samples (a declared law of the base counts as one).
  bool linear() const;
  bool nonstationary() const;
  /// Declared and added delays [s].
  double delay_s(const Eigen::VectorXd& values) const;
  /// Of all effects at work.
  int steps_per_sample() const;
};

}  // namespace bodeflow::residual
