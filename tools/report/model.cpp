#include "report/model.hpp"

#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

using Shape = std::vector<std::uint64_t>;

constexpr std::size_t kMostStates = 600;  ///< beyond, a curve takes longer than it tells
constexpr std::size_t kMostRoots = 200;   ///< of a polynomial; beyond, rounding decides where they lie
constexpr Eigen::Index kManyStates = 30;  ///< above, one Hessenberg form for all lines costs less than a factorisation a line

Eigen::VectorXd vector_of(const Array& array, std::size_t from, std::size_t count) {
  return Eigen::Map<const Eigen::VectorXd>(array.re.data() + from, static_cast<Eigen::Index>(count));
}

Eigen::MatrixXd matrix_of(const Array& array) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.re.data(), static_cast<Eigen::Index>(array.shape[0]),
                                    static_cast<Eigen::Index>(array.shape[1]));
}

/// The polynomial of output i and input j.
Eigen::VectorXd polynomial_of(const Array& array, std::size_t i, std::size_t j) {
  if (array.shape.size() == 1) return vector_of(array, 0, array.size());
  const std::size_t count = array.shape[2];
  return vector_of(array, (i * array.shape[1] + j) * count, count);
}

bool read_transfer_function(const Record& record, Model& model) {
  const Array* numerator = record.array("numerator");
  const Array* denominator = record.array("denominator");
  if (numerator == nullptr || denominator == nullptr || numerator->size() == 0 || denominator->size() == 0) return false;
  if (numerator->is_complex() || denominator->is_complex()) return false;
  const Shape& shape = numerator->shape;
  if (shape.size() == 1) {
    model.outputs = model.inputs = 1;
    return denominator->shape.size() == 1;
  }
  if (shape.size() != 3) return false;
  model.outputs = shape[0];
  model.inputs = shape[1];
  const Shape& below = denominator->shape;
  return below.size() == 1 || (below.size() == 3 && below[0] == shape[0] && below[1] == shape[1]);
}

bool read_state_space(const Record& record, Model& model) {
  const Array* D = record.array("D");
  if (D == nullptr || D->shape.size() != 2 || D->is_complex()) return false;
  model.outputs = D->shape[0];
  model.inputs = D->shape[1];
  const Array* A = record.array("A");
  if (A == nullptr || A->shape.size() != 2) return false;
  const std::uint64_t states = A->shape[0];
  return states <= kMostStates && record.array("A", {states, states}) != nullptr &&
         record.array("B", {states, model.inputs}) != nullptr && record.array("C", {model.outputs, states}) != nullptr;
}

/// A model whose response is numerator over denominator: those with physical parameters state them as well.
bool is_rational(const Record& record) {
  const std::string form = record.text("form");
  return form == "transfer_function" || form == "physical";
}

Root root_at(const Array& values, const Array* covariance, std::size_t n) {
  Root root{values.at(n), false, 0.0, 0.0, 0.0};
  if (covariance == nullptr) return root;
  const double* c = covariance->re.data() + 4 * n;
  root.has_covariance = std::isfinite(c[0]) && std::isfinite(c[1]) && std::isfinite(c[3]) && c[0] >= 0.0 && c[3] >= 0.0;
  root.real_variance = c[0];
  root.covariance = c[1];
  root.imaginary_variance = c[3];
  return root;
}

/// The response of the system with its input held over `hold` and late by `delay`; nothing where it can't be held.
std::optional<Eigen::VectorXcd> held_response(const numerics::TransferFunction& system, double hold, double delay,
                                              const Eigen::VectorXd& frequency) {
  const auto states = numerics::to_state_space(system);
  if (!states) return {};
  const auto held = numerics::zero_order_hold(*states, hold, delay);
  if (!held) return {};
  const auto curve = numerics::frequency_response(held->model, frequency);
  Eigen::VectorXcd values(frequency.size());
  const double late = -2.0 * std::numbers::pi * hold * static_cast<double>(held->delay);
  for (Eigen::Index k = 0; k < values.size(); ++k)
    values[k] = curve[static_cast<std::size_t>(k)](0, 0) * std::polar(1.0, late * frequency[k]);
  return values;
}

void delayed(std::vector<std::complex<double>>& values, const std::vector<double>& frequency, double delay) {
  if (delay == 0.0) return;
  for (std::size_t k = 0; k < values.size(); ++k) values[k] *= std::polar(1.0, -2.0 * std::numbers::pi * frequency[k] * delay);
}

std::vector<std::vector<std::complex<double>>> rational_responses(const Model& model, const Eigen::VectorXd& lines) {
  const std::vector<double> frequency(lines.begin(), lines.end());
  std::vector<std::vector<std::complex<double>>> values;
  for (std::size_t i = 0; i < model.outputs; ++i)
    for (std::size_t j = 0; j < model.inputs; ++j) {
      const numerics::TransferFunction system{polynomial_of(*model.record->array("numerator"), i, j),
                                              polynomial_of(*model.record->array("denominator"), i, j), model.sample_time};
      const auto held = model.hold > 0.0 ? held_response(system, model.hold, std::max(model.delay, 0.0), lines) : std::nullopt;
      const Eigen::VectorXcd curve = held ? *held : numerics::frequency_response(system, lines);
      values.emplace_back(curve.begin(), curve.end());
      if (!held) delayed(values.back(), frequency, model.delay);
    }
  return values;
}

std::vector<std::vector<std::complex<double>>> state_space_responses(const Record& record, double sample_time,
                                                                     const Eigen::VectorXd& lines) {
  const numerics::StateSpace system{matrix_of(*record.array("A")), matrix_of(*record.array("B")), matrix_of(*record.array("C")),
                                    matrix_of(*record.array("D")), sample_time};
  const auto curve =
      system.states() > kManyStates ? numerics::hessenberg_response(system, lines) : numerics::frequency_response(system, lines);
  std::vector<std::vector<std::complex<double>>> values;
  for (Eigen::Index i = 0; i < system.D.rows(); ++i)
    for (Eigen::Index j = 0; j < system.D.cols(); ++j) {
      auto& channel = values.emplace_back();
      for (const Eigen::MatrixXcd& at_line : curve) channel.push_back(at_line(i, j));
    }
  return values;
}

}  // namespace

std::optional<Model> read_model(const Record& record) {
  if (record.type != "model") return {};
  Model model;
  model.record = &record;
  const std::string form = record.text("form");
  const bool fits = is_rational(record)     ? read_transfer_function(record, model)
                    : form == "state_space" ? read_state_space(record, model)
                                            : false;
  if (!fits || model.outputs == 0 || model.inputs == 0) return {};
  const double sample_time = record.number("sample_time"), delay = record.number("delay");
  model.sample_time = sample_time > 0.0 ? sample_time : 0.0;
  model.delay = std::isfinite(delay) ? delay : 0.0;
  const double rate = record.number("sample_rate");
  if (record.text("hold") == "zero_order" && is_rational(record) && model.sample_time == 0.0 && rate > 0.0)
    model.hold = 1.0 / rate;
  return model;
}

std::vector<std::vector<std::complex<double>>> Model::responses(const std::vector<double>& frequency) const {
  const Eigen::VectorXd lines = Eigen::Map<const Eigen::VectorXd>(frequency.data(), static_cast<Eigen::Index>(frequency.size()));
  if (is_rational(*record)) return rational_responses(*this, lines);
  auto values = state_space_responses(*record, sample_time, lines);
  for (auto& channel : values) delayed(channel, frequency, delay);
  return values;
}

std::vector<Root> roots_of(const Record& record, bool poles) {
  std::vector<Root> roots;
  if (const Array* given = record.array(poles ? "poles" : "zeros"); given != nullptr && given->shape.size() == 1) {
    const Array* covariance = record.array(poles ? "pole_covariance" : "zero_covariance", {given->shape[0], 2, 2});
    for (std::size_t n = 0; n < given->size(); ++n) roots.push_back(root_at(*given, covariance, n));
    return roots;
  }
  const auto model = read_model(record);
  if (!model || model->outputs * model->inputs != 1 || !is_rational(record)) return roots;
  const Array& polynomial = *record.array(poles ? "denominator" : "numerator");
  if (polynomial.size() > kMostRoots) return roots;
  if (const auto found = numerics::roots(numerics::trimmed(polynomial_of(polynomial, 0, 0))))
    for (const auto& root : *found) roots.push_back({root, false, 0.0, 0.0, 0.0});
  return roots;
}

}  // namespace bodeflow::tools::report
