#pragma once

#include <bodeflow/record_view.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "trace/measurement.hpp"
#include "trace/remedy.hpp"

namespace bodeflow::residual {

/// What a record `trace` tells of the model, as it stands in its attributes and arrays:
///   base (id), declarations (list of "name=value"), parameter_names, parameters_before, parameters_after,
///   effects (names in the order of their weight, without the place), effect_places ("" where an effect has none),
///   effect_parameter_counts (list of integers), effect_parameter_names, effect_parameter_units, effect_parameters (of all
///   effects, one after the other).
struct ToldModel {
  std::string verdict, unit;
  std::string base;
  std::vector<std::string> declarations;
  std::vector<std::string> parameter_names;
  std::vector<double> before, after;
  std::vector<NamedEffect> effects;
};

/// Throws Failure, by name, for a record that does not tell it.
ToldModel read_told_model(const RecordView& trace);

/// Finds a base model and effects among the parts of the host.
struct PartsInReach {
  std::function<std::shared_ptr<const BaseModel>(const std::string& id, const std::vector<std::string>& declarations)> base;
  std::function<CatalogueEntry(const std::string& name)> effect;
};

/// A joint model with the values of its parameters.
struct RebuiltModel {
  JointModel model;
  Eigen::VectorXd values;
};

/// The model that was told, with its fitted values, without those effects whose number in `effects` is in `left_out`. Throws
/// Failure where a part is not there or has other parameters than the record.
RebuiltModel rebuild(const ToldModel& told, const PartsInReach& parts, const std::vector<std::size_t>& left_out);

}  // namespace bodeflow::residual
