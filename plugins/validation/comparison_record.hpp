#pragma once

#include <bodeflow/record.hpp>
#include <optional>
#include <string>
#include <vector>

#include "judgement.hpp"
#include "model_table.hpp"
#include "records/signals.hpp"

namespace bodeflow::validation {

/// Models, and what data say of them where there are data.
struct Comparison {
  std::vector<std::string> names;  ///< one a model
  std::vector<records::ModelData> models;
  ParameterTable parameters;
  std::vector<Eigen::VectorXcd> poles;  ///< of each model, rad/s
  Eigen::VectorXd frequency_hz;         ///< of the responses; may be empty
  std::vector<std::string> warnings;

  JudgementSettings settings;
  Measured data;
  records::Signals input_signal, output_signal;
  std::vector<Judgement> judgements;  ///< one a model, or none
  std::vector<Hold> holds;            ///< of the judgements
  Eigen::Index shown = 500;           ///< samples of the signals that the record holds
};

/// What the models are, side by side: parameters, poles, responses, and a warning where they can't be compared as independent
/// estimates. Errors: those of poles_rad_s.
Expected<Comparison> compare_models(std::vector<std::string> names, std::vector<records::ModelData> models);

/// The record `comparison`.
RecordBuilder write_comparison(const Comparison& comparison);

}  // namespace bodeflow::validation
