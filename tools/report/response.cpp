#include "report/response.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <cmath>
#include <numeric>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

double degrees_of_freedom_of(const Record& record) {
  const double given = record.number("degrees_of_freedom");
  if (std::isfinite(given)) return given;
  const double periods = record.number("periods");
  return periods >= 2.0 ? periods - 1.0 : kNaN;
}

}  // namespace

std::string Response::output(std::size_t i) const {
  return record->text_at("output_names", i, "output " + std::to_string(i + 1));
}

std::string Response::input(std::size_t j) const { return record->text_at("input_names", j, "input " + std::to_string(j + 1)); }

std::string Response::unit(std::size_t i, std::size_t j) const {
  const auto units = record->texts("response_units");
  if (units.size() == outputs * inputs) return units[i * inputs + j];
  if (units.size() == outputs && inputs > 0 && j == 0) return units[i];
  return response_->unit;
}

std::string Response::pair_name(std::size_t i, std::size_t j) const { return output(i) + " / " + input(j); }

std::complex<double> Response::value(std::size_t k, std::size_t i, std::size_t j) const { return response_->at(at(k, i, j)); }

double Response::variance(std::size_t k, std::size_t i, std::size_t j) const {
  return variance_ == nullptr ? kNaN : variance_->re[at(k, i, j)];
}

double Response::radius(std::size_t k, std::size_t i, std::size_t j) const {
  if (radius_ != nullptr) return radius_->re[at(k, i, j)];
  const double s2 = variance(k, i, j);
  if (!(s2 >= 0.0) || !(degrees_of_freedom > 0.0)) return kNaN;
  return numerics::confidence_radius(s2, degrees_of_freedom, confidence);
}

const Array* Response::of_pairs(const std::string& name) const { return record->array(name, response_->shape); }

const Array* Response::of_outputs(const std::string& name, bool complex) const {
  return record->array(name, {response_->shape[0], response_->shape[1]}, complex);
}

std::optional<Response> read_response(const Record& record) {
  if (record.type != "frequency_response") return {};
  const Array* frequency = record.array("frequency");
  const Array* response = record.array("response");
  if (frequency == nullptr || response == nullptr || frequency->is_complex() || frequency->size() == 0) return {};
  if (response->shape.size() != 3 || response->shape[0] != frequency->size() || response->size() == 0) return {};

  Response read;
  read.record = &record;
  read.response_ = response;
  read.variance_ = record.array("variance", response->shape);
  read.radius_ = record.array("confidence_radius", response->shape);
  read.outputs = response->shape[1];
  read.inputs = response->shape[2];
  const double confidence = record.number("confidence");
  if (confidence > 0.0 && confidence < 1.0) read.confidence = confidence;
  read.degrees_of_freedom = degrees_of_freedom_of(record);
  for (std::size_t k = 0; k < frequency->size(); ++k)
    if (std::isfinite(frequency->re[k])) read.line.push_back(k);
  std::stable_sort(read.line.begin(), read.line.end(),
                   [&](std::size_t a, std::size_t b) { return frequency->re[a] < frequency->re[b]; });
  for (const std::size_t k : read.line) read.frequency.push_back(frequency->re[k]);
  if (read.line.empty()) return {};
  return read;
}

}  // namespace bodeflow::tools::report
