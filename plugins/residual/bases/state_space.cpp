#include "state_space.hpp"

#include <Eigen/Core>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <cmath>

#include "declared_timing.hpp"
#include "gain_start.hpp"
#include "records/model.hpp"
#include "records/record_arrays.hpp"

namespace bodeflow::residual {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix_in(const RecordView& record, const char* name) {
  const auto array = record.array(name);
  if (!array) fail("the model has no array '" + std::string(name) + "'");
  if (array->shape.size() != 2)
    fail("array '" + std::string(name) + "' is " + records::shape_text(array->shape) + "; needed: a matrix");
  auto m = records::matrix_of<double>(*array, static_cast<Eigen::Index>(array->shape[0]));
  if (!m) fail(m.error().text);
  if (m->cols() != static_cast<Eigen::Index>(array->shape[1])) m->resize(m->rows(), static_cast<Eigen::Index>(array->shape[1]));
  return *m;
}

numerics::StateSpace matrices_of(const RecordView& record) {
  auto system = numerics::make_state_space(matrix_in(record, "A"), matrix_in(record, "B"), matrix_in(record, "C"),
                                           matrix_in(record, "D"), record.number("sample_time").value_or(0.0));
  if (!system) fail("the model: " + system.error().text);
  return *system;
}

void copy(const Eigen::MatrixXd& from, std::vector<double>& to) { RowMajor::Map(to.data(), from.rows(), from.cols()) = from; }

numerics::StateSpace system_of(const LinearPlant& p) {
  const auto as = [](const std::vector<double>& v, int rows, int columns) {
    return Eigen::MatrixXd(Eigen::Map<const RowMajor>(v.data(), rows, columns));
  };
  return {as(p.A, p.states, p.states), as(p.B, p.states, p.inputs), as(p.C, 1, p.states), as(p.D, 1, p.inputs), 0.0};
}

}  // namespace

void StateSpaceModel::describe(Describe& d) {
  d.id("residual.state_space")
      .summary("A black box: an identified model as it is, up to a gain of each input.")
      .doc(
          "Takes a record `model` in continuous time: A, B, C, D with one output, or numerator and denominator. It has no "
          "places: only "
          "effects of input, output and response can be added. What the identification has put into its coefficients for want of "
          "the "
          "effect stays there; where the orders are known, transfer_function fits them together with the effect.");
  describe_timing(d, Hold::band_limited);
}

void StateSpaceModel::configure(const Parameters& p) { timing_ = read_timing(p); }

void StateSpaceModel::use_model(const RecordView& record) {
  if (record.type() != "model") fail("state_space takes a record 'model', not '" + std::string(record.type()) + "'");
  numerics::StateSpace system;
  double delay_s = record.number("delay").value_or(0.0);
  method_ = record.text("method").value_or("");
  if (record.array("A")) {
    system = matrices_of(record);
  } else {
    const auto model = records::read_model(record);
    if (!model) fail("the model: " + model.error().text);
    delay_s = model->delay_s;
    auto made = numerics::to_state_space(numerics::TransferFunction{model->numerator, model->denominator, model->sample_time_s});
    if (!made) fail("the model: " + made.error().text);
    system = std::move(*made);
  }
  if (system.sample_time > 0.0)
    fail("the model is in discrete time, with a sample time of " + short_text(system.sample_time) +
         " s; needed: one in continuous time");
  if (system.outputs() != 1) fail("the model has " + std::to_string(system.outputs()) + " outputs; needed: one");
  if (delay_s < 0.0) fail("the model has a delay of " + short_text(delay_s) + " s; allowed: 0 and more");
  plant_.resize(static_cast<int>(system.states()), static_cast<int>(system.inputs()), 0);
  copy(system.A, plant_.A), copy(system.B, plant_.B), copy(system.C, plant_.C), copy(system.D, plant_.D);
  model_delay_s_ = delay_s;
}

Timing StateSpaceModel::timing() const { return {timing_.hold, timing_.delay_s + model_delay_s_}; }

std::vector<FitParameter> StateSpaceModel::parameters() const { return gain_parameters(plant_.inputs); }

std::vector<PlantInput> StateSpaceModel::inputs() const {
  std::vector<PlantInput> all;
  for (int j = 0; j < plant_.inputs; ++j) all.push_back({j, 0});
  return all;
}

std::vector<std::string> StateSpaceModel::conventions() const {
  std::vector<std::string> words = {
      "a black box" + (method_.empty() ? "" : " that " + method_ + " identified") +
      ", taken as it is up to a gain of each input: only effects of input, output and response can be "
      "added, none inside the plant"};
  for (std::string& text : timing_words(timing())) words.push_back(std::move(text));
  return words;
}

std::vector<std::vector<double>> StateSpaceModel::starts(std::span<const MeasuredResponse> measured) const {
  if (plant_.D.empty()) fail("state_space needs a record 'model' with the model itself");
  const numerics::StateSpace system = system_of(plant_);
  return {gains_near(measured, plant_.inputs, [&system](int j, double f) {
    return numerics::frequency_response(system, Eigen::VectorXd::Constant(1, f)).front()(0, j);
  })};
}

bool StateSpaceModel::state_space(const double* v, const double*, LinearPlant& plant) const {
  if (plant_.D.empty()) return false;  // no model was taken
  plant = plant_;
  const auto q = static_cast<std::size_t>(plant_.inputs);
  for (std::size_t i = 0; i < plant.B.size(); ++i) plant.B[i] *= v[i % q];
  for (std::size_t j = 0; j < q; ++j) {
    plant.D[j] *= v[j];
    if (!std::isfinite(v[j])) return false;
  }
  return true;
}

}  // namespace bodeflow::residual
