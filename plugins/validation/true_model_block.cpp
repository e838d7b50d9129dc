#include "true_model_block.hpp"

#include <algorithm>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

#include "response_error.hpp"

namespace bodeflow::validation {
namespace {

Eigen::VectorXd polynomial(const Parameters& p, const char* name) {
  const auto& values = p.numbers(name);
  const Eigen::VectorXd given = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  const Eigen::VectorXd left = given.allFinite() ? numerics::trimmed(given) : Eigen::VectorXd();
  if (left.size() == 0) fail(std::string(name) + " needs finite coefficients, one of them not 0");
  return left;
}

Eigen::VectorXcd roots_of(const Eigen::VectorXd& p) {
  const auto roots = numerics::roots(p);
  if (!roots) fail(roots.error().text);
  return *roots;
}

/// Coefficients with their exact values as parameters: b0 .. of the numerator, a1 .. of the denominator, which begins with 1.
void add_parameters(records::ModelData& m) {
  const Eigen::Index b = m.numerator.size(), a = m.denominator.size() - 1;
  for (Eigen::Index i = 1; i <= a; ++i) m.parameter_names.push_back("a" + std::to_string(i));
  for (Eigen::Index i = a + 1 - b; i <= a; ++i) m.parameter_names.push_back("b" + std::to_string(i));
  m.parameter_units.resize(m.parameter_names.size());
  m.parameters.resize(a + b);
  m.parameters << m.denominator.tail(a), m.numerator;
  m.covariance = Eigen::MatrixXd::Zero(a + b, a + b);
}

}  // namespace

void TrueModel::describe(Describe& d) {
  d.id("validation.true_model").summary("The model that a bench simulates, and how far a measured response is from it.");
  d.doc(
      "Stands behind the response of a Monte Carlo study (validation.monte_carlo, port response) or of a measurement: the report "
      "draws the true model over it, and `error` says how far it is off.");
  d.message_in(response).record_type("frequency_response").optional().doc("of one input and one output");
  d.message_out(model).record_type("model").doc("the true one, without uncertainty");
  d.message_out(error)
      .record_type("response_error")
      .doc(
          "root mean square over the lines of the relative error: error_of_mean of the response, error_of_one_run with its "
          "variance; "
          "arrays frequency and relative_error");
  d.required<std::vector<double>>("numerator").unit("").doc("descending powers of s or z");
  d.required<std::vector<double>>("denominator").unit("").doc("descending powers of s or z, at least of the numerator's degree");
  d.parameter("sample_rate", 0.0).unit("Hz").range(0, 1e15).doc("of a discrete-time model; 0: continuous in time");
  d.parameter("delay", 0.0).unit("s").range(0, 1e6).doc("of the output, beside the rest");
}

void TrueModel::configure(const Parameters& p) {
  truth_ = records::ModelData{};
  truth_.method = "validation.true_model";
  truth_.form = "transfer_function";
  truth_.numerator = polynomial(p, "numerator");
  truth_.denominator = polynomial(p, "denominator");
  if (truth_.numerator.size() > truth_.denominator.size()) fail("the numerator has a higher degree than the denominator");
  truth_.numerator /= truth_.denominator[0];
  truth_.denominator /= truth_.denominator[0];
  truth_.order = truth_.denominator.size() - 1;
  truth_.delay_s = p.number("delay");
  if (p.number("sample_rate") > 0.0) truth_.sample_time_s = 1.0 / p.number("sample_rate");
  truth_.poles = roots_of(truth_.denominator);
  truth_.zeros = roots_of(truth_.numerator);
  add_parameters(truth_);
}

void TrueModel::receive(int, const RecordView& record, Io&) {
  auto data = records::read_response(record);
  if (!data) fail(data.error().text);
  found_ = std::move(*data);
}

void TrueModel::finish(Io& io) {
  io.emit(model, records::write_model(truth_));
  if (!found_) return;
  const auto e = response_error(*found_, truth_);
  if (!e) fail(e.error().text);
  RecordBuilder r("response_error");
  r.set("error_of_mean", e->of_mean);
  if (std::isfinite(e->of_one_run)) r.set("error_of_one_run", e->of_one_run);
  r.set("lines", e->relative.size());
  const auto lines = static_cast<std::uint64_t>(e->relative.size());
  std::copy(found_->frequency_hz.begin(), found_->frequency_hz.end(), r.array<double>("frequency", "Hz", {lines}).begin());
  std::copy(e->relative.begin(), e->relative.end(), r.array<double>("relative_error", "1", {lines}).begin());
  io.emit(error, r);
}

void TrueModel::reset() { found_.reset(); }

}  // namespace bodeflow::validation
