#include "comparison_record.hpp"

#include <array>
#include <complex>
#include <limits>

#include "records/record_arrays.hpp"
#include "records/response_units.hpp"
#include "response_error.hpp"

namespace bodeflow::validation {
namespace {

using Complex = std::complex<double>;
constexpr Eigen::Index kGridPoints = 200;

template <class Get>
void put_each(RecordBuilder& r, const char* name, const std::string& unit, const std::vector<Judgement>& judgements, Get get) {
  const auto data = r.array<double>(name, unit, std::array{judgements.size()});
  for (std::size_t i = 0; i < judgements.size(); ++i) data[i] = get(judgements[i]);
}

/// models x values, `count` of each.
template <class Get>
void put_rows(RecordBuilder& r, const char* name, const std::string& unit, const std::vector<Judgement>& judgements,
              Eigen::Index count, Get get) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(judgements.size()), count);
  for (std::size_t i = 0; i < judgements.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = get(judgements[i]).transpose();
  records::put_matrix(r, name, unit, rows);
}

void put_models(RecordBuilder& r, const Comparison& c) {
  std::vector<std::string> methods;
  for (const auto& m : c.models) methods.push_back(m.method);
  r.set("models", c.names);
  r.set("methods", methods);
  const ParameterTable& t = c.parameters;
  r.set("parameter_names", t.names);
  r.set("parameter_units", t.units);
  if (!t.names.empty()) {
    records::put_matrix(r, "parameters", "", t.values);
    records::put_matrix(r, "parameter_std", "", t.deviations);
    if (c.models.size() > 1) {
      records::put_matrix(r, "parameter_difference", "", t.difference);
      records::put_list<double>(r, "parameter_probability", "", t.probability);
    }
  }
  Eigen::Index most = 0;
  for (const auto& poles : c.poles) most = std::max(most, poles.size());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::MatrixXcd poles = Eigen::MatrixXcd::Constant(static_cast<Eigen::Index>(c.models.size()), most, Complex(nan, nan));
  for (std::size_t i = 0; i < c.poles.size(); ++i)
    poles.row(static_cast<Eigen::Index>(i)).head(c.poles[i].size()) = c.poles[i].transpose();
  records::put<Complex>(r, "poles", "rad/s", std::array{c.models.size(), static_cast<std::size_t>(most)}, poles);
}

void put_responses(RecordBuilder& r, const Comparison& c) {
  if (c.frequency_hz.size() == 0) return;
  std::vector<std::string> units;
  Eigen::MatrixXcd responses(static_cast<Eigen::Index>(c.models.size()), c.frequency_hz.size());
  for (std::size_t i = 0; i < c.models.size(); ++i) {
    units.push_back(records::ratio_unit(c.models[i].output_unit, c.models[i].input_unit));
    responses.row(static_cast<Eigen::Index>(i)) = model_response(c.models[i], c.frequency_hz).transpose();
  }
  records::put_list<double>(r, "frequency", "Hz", c.frequency_hz);
  records::put<Complex>(r, "response", records::common_unit(units),
                        std::array{c.models.size(), static_cast<std::size_t>(c.frequency_hz.size())}, responses);
}

std::string noise_model_text(const Judgement& j) {
  if (j.unstable) return "white noise through the model's poles, those that are unstable mirrored";
  const auto order = j.noise.coefficients.size();
  return order == 0 ? "white noise" : "autoregression of order " + std::to_string(order);
}

void put_figures(RecordBuilder& r, const Comparison& c) {
  const auto& js = c.judgements;
  const std::string unit = c.output_signal.units.front();
  const auto each = [&](const char* name, const std::string& of, auto get) { put_each(r, name, of, js, get); };
  each("fit", "%", [](const Judgement& j) { return j.fit; });
  each("prediction_fit", "%", [](const Judgement& j) { return j.prediction_fit; });
  each("residual_std", unit, [](const Judgement& j) { return j.residual_std; });
  each("prediction_std", unit, [](const Judgement& j) { return j.prediction_std; });
  each("expected_prediction_std", unit, [](const Judgement& j) { return j.expected_prediction_std; });
  each("fpe", records::squared_unit(unit), [](const Judgement& j) { return j.fpe; });
  each("aic", "", [](const Judgement& j) { return j.aic; });
  each("offset", unit, [](const Judgement& j) { return j.simulation.offset; });
  each("noise_order", "", [](const Judgement& j) { return static_cast<double>(j.noise.coefficients.size()); });
  each("whiteness_probability", "", [](const Judgement& j) { return j.innovation.whiteness_probability; });
  each("input_outside_band", "", [](const Judgement& j) { return j.input_outside; });
  each("output_outside_band", "", [](const Judgement& j) { return j.output_outside; });
}

void put_correlations(RecordBuilder& r, const Comparison& c) {
  const auto& js = c.judgements;
  const Eigen::Index lags = c.settings.lags;
  records::put_list<double>(r, "lag", "",
                            Eigen::VectorXd::LinSpaced(2 * lags + 1, -static_cast<double>(lags), static_cast<double>(lags)));
  put_rows(r, "residual_autocorrelation", "", js, lags + 1, [](const Judgement& j) { return j.residual.autocorrelation; });
  put_rows(r, "innovation_autocorrelation", "", js, lags + 1, [](const Judgement& j) { return j.innovation.autocorrelation; });
  put_rows(r, "cross_correlation", "", js, 2 * lags + 1, [](const Judgement& j) { return j.residual.cross_correlation; });
  put_each(r, "autocorrelation_band", "", js, [](const Judgement& j) { return j.residual.autocorrelation_band; });
  put_each(r, "cross_correlation_band", "", js, [](const Judgement& j) { return j.residual.cross_correlation_band; });
  put_each(r, "cross_outside", "", js, [](const Judgement& j) { return static_cast<double>(j.residual.cross_outside); });
}

/// The first samples from the one on at which all models are simulated.
void put_signals(RecordBuilder& r, const Comparison& c) {
  Eigen::Index first = 0;
  for (const Judgement& j : c.judgements) first = std::max(first, j.simulation.first);
  const Eigen::Index count = std::min(c.shown, c.data.output.size() - first);
  const std::string unit = c.output_signal.units.front();
  const Eigen::VectorXd time =
      Eigen::VectorXd::LinSpaced(count, static_cast<double>(first), static_cast<double>(first + count - 1));
  records::put_list<double>(r, "time", "s", time / c.data.sample_rate_hz);
  records::put_list<double>(r, "measured", unit, c.data.output.segment(first, count));
  put_rows(r, "simulated", unit, c.judgements, count,
           [&](const Judgement& j) { return j.simulation.output.segment(first - j.simulation.first, count); });
  put_rows(r, "predicted", unit, c.judgements, count,
           [&](const Judgement& j) { return j.prediction.segment(first - j.simulation.first, count); });
}

}  // namespace

Expected<Comparison> compare_models(std::vector<std::string> names, std::vector<records::ModelData> models) {
  Comparison c;
  c.names = std::move(names);
  c.models = std::move(models);
  c.parameters = parameter_table(c.names, c.models);
  for (std::size_t i = 0; i < c.models.size(); ++i) {
    auto poles = poles_rad_s(c.models[i]);
    if (!poles) return unexpected("model '" + c.names[i] + "': " + poles.error().text);
    c.poles.push_back(std::move(*poles));
  }
  c.frequency_hz = common_grid(c.models, kGridPoints);
  for (std::size_t i = 1; i < c.models.size(); ++i) {
    const auto &a = c.models.front(), &b = c.models[i];
    if (!a.data_checksum.empty() && a.data_checksum == b.data_checksum)
      c.warnings.push_back("'" + c.names.front() + "' and '" + c.names[i] +
                           "' come from the same data: their errors are alike, and differences in standard deviations are too "
                           "small; identify from different data to see what is significant");
    const std::string of_a = records::ratio_unit(a.output_unit, a.input_unit),
                      of_b = records::ratio_unit(b.output_unit, b.input_unit);
    const bool known = !a.output_unit.empty() && !b.output_unit.empty() && !a.input_unit.empty() && !b.input_unit.empty();
    if (known && of_a != of_b)
      c.warnings.push_back("'" + c.names.front() + "' gives " + of_a + ", '" + c.names[i] + "' " + of_b +
                           ": their responses stand in different units; identify from signals in the same units");
  }
  return c;
}

RecordBuilder write_comparison(const Comparison& c) {
  RecordBuilder r("comparison");
  put_models(r, c);
  put_responses(r, c);
  std::vector<std::string> warnings = c.warnings;
  for (std::size_t i = 0; i < c.judgements.size(); ++i)
    for (const std::string& warning : c.judgements[i].warnings) warnings.push_back("model '" + c.names[i] + "': " + warning);
  r.set("warnings", warnings);
  if (c.judgements.empty()) return r;

  r.set("samples", static_cast<std::int64_t>(c.data.output.size()));
  r.set("sample_rate", c.data.sample_rate_hz);
  r.set("input_names", c.input_signal.names);
  r.set("input_units", c.input_signal.units);
  r.set("output_names", c.output_signal.names);
  r.set("output_units", c.output_signal.units);
  r.set("steps", static_cast<std::int64_t>(c.settings.steps));
  r.set("confidence", c.settings.confidence);
  r.set("estimated", c.settings.offset ? "initial state and output offset, from these data" : "initial state, from these data");
  std::vector<std::string> between;
  for (std::size_t i = 0; i < c.holds.size(); ++i)
    between.emplace_back(c.models[i].sample_time_s > 0.0   ? "discrete-time model"
                         : c.holds[i] == Hold::first_order ? "linear between samples"
                                                           : "held over each sample");
  r.set("input_between_samples", between);
  std::vector<std::string> noise_models;
  for (const Judgement& j : c.judgements) noise_models.push_back(noise_model_text(j));
  r.set("noise_models", noise_models);
  r.set("noise_models_from", "the simulation's residual of these data, order by AICc");
  put_figures(r, c);
  put_correlations(r, c);
  put_signals(r, c);
  return r;
}

}  // namespace bodeflow::validation
