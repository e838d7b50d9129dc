#include "export/model_file.hpp"

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "acquisition/result_file.hpp"
#include "export/mat_file.hpp"
#include "export/matlab_script.hpp"
#include "export/record_text.hpp"
#include "record/json_text.hpp"

namespace bodeflow::tools::exports {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_names(const records::Signals& several, const std::string& one) {
  return several.names.empty() ? std::vector<std::string>{one} : several.names;
}

void put_matrix(nlohmann::ordered_json& arrays, const char* name, const Eigen::MatrixXd& m) {
  nlohmann::ordered_json data = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) data.push_back(m(i, j));
  arrays[name] = {{"unit", ""}, {"shape", {m.rows(), m.cols()}}, {"data", data}};
}

Result<ModelFile> from_results(const std::string& path, const std::string& key) {
  const auto found = acquisition::read_result(path, key, "model");
  if (!found) return refused(found.error().text);
  // A view needs the alignment that a vector does not promise.
  const std::unique_ptr<void, decltype(&std::free)> bytes(std::aligned_alloc(64, found->record.size()), &std::free);
  found->record.write(bytes.get());
  auto model = records::read_linear_model(RecordView(static_cast<const std::uint8_t*>(bytes.get())));
  if (!model) return refused(found->file + ": result '" + found->name + "': " + model.error().text);
  auto system = records::state_space_of(*model);
  if (!system) return refused(found->file + ": result '" + found->name + "': " + system.error().text);
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(json_of_record(found->record.bytes()));
  if (!model->state_space) {
    for (const auto& [name, matrix] : {std::pair{"A", system->A}, {"B", system->B}, {"C", system->C}, {"D", system->D}})
      put_matrix(json["arrays"], name, matrix);
  }
  model->state_space = std::move(*system);
  fs::path place = fs::absolute(path).lexically_normal();
  if (!place.has_filename() || place.filename() == "result.json") place = place.parent_path();
  const std::string name = place.extension() == ".json" ? place.stem().string() : place.filename().string();
  return ModelFile{name, std::move(*model), record::json_text(json)};
}

}  // namespace

std::vector<std::string> ModelFile::input_names() const { return all_names(model.inputs, model.input_name); }
std::vector<std::string> ModelFile::output_names() const { return all_names(model.outputs, model.output_name); }

Result<std::string> bytes_of(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return refused(path + ": a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) return refused(path + ": can't be read");
  return std::string(std::istreambuf_iterator<char>(file), {});
}

Result<ModelFile> model_of(const std::string& name, numerics::StateSpace system, double delay_s, const Eigen::VectorXd& numerator,
                           const Eigen::VectorXd& denominator, const std::vector<std::string>& inputs,
                           const std::vector<std::string>& outputs) {
  const auto fits = [](const std::vector<std::string>& names, Eigen::Index count) {
    return static_cast<Eigen::Index>(names.size()) == count;
  };
  if ((!inputs.empty() && !fits(inputs, system.inputs())) || (!outputs.empty() && !fits(outputs, system.outputs())))
    return refused(name + ": the names of inputs or outputs do not fit B, C and D");
  records::ModelData m;
  m.form = "state_space";
  m.order = system.states();
  m.sample_time_s = system.sample_time;
  m.delay_s = delay_s;
  m.numerator = numerator;
  m.denominator = denominator;
  if (system.states() > 0) m.poles = system.A.eigenvalues();
  const auto named = [](std::vector<std::string> names, Eigen::Index count, const char* word) {
    for (Eigen::Index i = static_cast<Eigen::Index>(names.size()); i < count; ++i)
      names.push_back(count == 1 ? word : word + ("_" + std::to_string(i + 1)));
    return records::Signals{names, std::vector<std::string>(names.size())};
  };
  const records::Signals all_inputs = named(inputs, system.inputs(), "input"),
                         all_outputs = named(outputs, system.outputs(), "output");
  m.input_name = all_inputs.names.front();
  m.output_name = all_outputs.names.front();
  if (all_inputs.names.size() > 1) m.inputs = all_inputs;
  if (all_outputs.names.size() > 1) m.outputs = all_outputs;
  m.state_space = std::move(system);
  std::string json = json_of_record(records::write_model(m).bytes());
  return ModelFile{name, std::move(m), std::move(json)};
}

Result<ModelFile> read_model_file(const std::string& path, const std::string& key) {
  const fs::path place(path);
  const std::string ending = place.extension().string();
  if (ending != ".mat" && ending != ".m") return from_results(path, key);
  const auto bytes = bytes_of(path);
  if (!bytes) return refused(bytes.error());
  auto file = ending == ".mat" ? model_in_mat(place.stem().string(), *bytes) : model_in_matlab(place.stem().string(), *bytes);
  if (!file) return refused(path + ": " + file.error());
  return file;
}

std::string json_of(const ModelFile& file) {
  nlohmann::ordered_json json;
  json["bodeflow"] = 1;
  json["graph"] = file.name;
  json["status"] = "complete";
  json["results"]["model"] = nlohmann::ordered_json::parse(file.json);
  return record::json_text(json) + "\n";
}

}  // namespace bodeflow::tools::exports
