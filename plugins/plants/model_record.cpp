#include "model_record.hpp"

#include <Eigen/Eigenvalues>

#include "records/model.hpp"

namespace bodeflow::plants {
namespace {

std::vector<std::string> numbered(const char* name, Eigen::Index count) {
  if (count == 1) return {name};
  std::vector<std::string> names;
  for (Eigen::Index i = 1; i <= count; ++i) names.push_back(name + std::to_string(i));
  return names;
}

}  // namespace

RecordBuilder known_model(const std::string& method, const numerics::StateSpace& system, std::vector<std::string> inputs,
                          std::vector<std::string> outputs, std::vector<std::string> input_units,
                          std::vector<std::string> output_units) {
  records::ModelData m;
  m.method = method;
  m.form = "state_space";
  m.order = system.states();
  m.sample_time_s = system.sample_time;
  m.state_space = system;
  m.poles = system.A.eigenvalues();
  m.inputs = {inputs.empty() ? numbered("u", system.inputs()) : std::move(inputs), std::move(input_units)};
  m.outputs = {outputs.empty() ? numbered("y", system.outputs()) : std::move(outputs), std::move(output_units)};
  m.inputs.units.resize(m.inputs.names.size());
  m.outputs.units.resize(m.outputs.names.size());
  m.input_name = m.inputs.names.front();
  m.output_name = m.outputs.names.front();
  m.input_unit = m.inputs.units.front();
  m.output_unit = m.outputs.units.front();
  return records::write_model(m);
}

}  // namespace bodeflow::plants
