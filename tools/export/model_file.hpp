#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "records/model.hpp"

namespace bodeflow::tools::exports {

template <class T>
using Result = tl::expected<T, std::string>;

/// The refusal as what a function of type Result<T> returns.
inline tl::unexpected<std::string> refused(std::string text) { return tl::unexpected<std::string>(std::move(text)); }

/// A linear model as files carry it: a state space always, numerator and denominator where the model has them, names and units of
/// its signals. `text` is its record as JSON, with all else that was known of it.
struct ModelFile {
  std::string name;  ///< for files and for what is in them
  records::ModelData model;
  std::string json;

  const numerics::StateSpace& system() const { return *model.state_space; }
  std::vector<std::string> input_names() const;
  std::vector<std::string> output_names() const;
};

/// The model in a file: a run directory, a result.json (or what `json_of` made), or what `mat_of` or `matlab_of` made, told apart
/// by the ending. `key`: of the record in a result.json; empty: the only model there. Errors: why not, with the file's name.
Result<ModelFile> read_model_file(const std::string& path, const std::string& key);

/// The file's text in the layout of result.json, with the one result `model`: commands that take a result.json take it.
std::string json_of(const ModelFile& file);

/// A model from a system and names, as files without a record give it.
Result<ModelFile> model_of(const std::string& name, numerics::StateSpace system, double delay_s, const Eigen::VectorXd& numerator,
                           const Eigen::VectorXd& denominator, const std::vector<std::string>& inputs,
                           const std::vector<std::string>& outputs);

/// The content of a file. Error: why not.
Result<std::string> bytes_of(const std::string& path);

}  // namespace bodeflow::tools::exports
