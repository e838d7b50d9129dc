#include "response.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <cmath>
#include <complex>
#include <limits>

#include "record_arrays.hpp"
#include "response_units.hpp"
#include "signals.hpp"

namespace bodeflow::records {
namespace {

using Complex = std::complex<double>;

std::vector<std::string> names_of(const RecordView& record, const char* attribute, std::size_t count, const char* otherwise) {
  std::vector<std::string> names;
  if (const auto given = record.texts(attribute)) names.assign(given->begin(), given->end());
  if (names.size() == count) return names;
  names.clear();
  for (std::size_t i = 0; i < count; ++i) names.push_back(count == 1 ? otherwise : otherwise + ("_" + std::to_string(i + 1)));
  return names;
}

Expected<Eigen::VectorXd> frequencies_of(const RecordView& record) {
  const auto array = record.array("frequency");
  if (!array) return unexpected("the record has no array 'frequency'");
  if (array->shape.size() != 1 || array->size == 0)
    return unexpected("array 'frequency' has " + shape_text(array->shape) + " values; needed: a list of at least one");
  auto m = matrix_of<double>(*array, static_cast<Eigen::Index>(array->size));
  if (!m) return unexpected(m.error().text);
  for (Eigen::Index k = 1; k < m->rows(); ++k) {
    if ((*m)(k, 0) > (*m)(k - 1, 0)) continue;
    return unexpected("array 'frequency' does not rise: " + short_number((*m)(k, 0)) + " Hz after " +
                      short_number((*m)(k - 1, 0)) + " Hz");
  }
  return Eigen::VectorXd(m->col(0));
}

/// The mean spectra, where the record has all of them for these lines; nothing where it has not.
Expected<std::optional<MeanSpectra>> spectra_of(const RecordView& record, Eigen::Index lines) {
  const char* names[] = {"input_mean", "output_mean", "input_variance", "output_variance", "cross_covariance"};
  for (const char* name : names) {
    const auto array = record.array(name);
    if (!array || array->size != static_cast<std::size_t>(lines)) return std::optional<MeanSpectra>();
  }
  MeanSpectra s;
  Eigen::VectorXcd* complex_lists[] = {&s.input, &s.output, &s.covariance};
  const char* complex_names[] = {"input_mean", "output_mean", "cross_covariance"};
  for (std::size_t i = 0; i < 3; ++i) {
    auto list = matrix_of<Complex>(*record.array(complex_names[i]), lines);
    if (!list) return unexpected(list.error().text);
    *complex_lists[i] = list->col(0);
  }
  Eigen::VectorXd* real_lists[] = {&s.input_variance, &s.output_variance};
  const char* real_names[] = {"input_variance", "output_variance"};
  for (std::size_t i = 0; i < 2; ++i) {
    auto list = matrix_of<double>(*record.array(real_names[i]), lines);
    if (!list) return unexpected(list.error().text);
    *real_lists[i] = list->col(0);
    if (real_lists[i]->minCoeff() < 0.0) return unexpected("array '" + std::string(real_names[i]) + "' has a negative value");
  }
  return std::optional<MeanSpectra>(std::move(s));
}

void read_attributes(const RecordView& record, ResponseData& d) {
  d.form = record.text("form").value_or("");
  d.method = record.text("method").value_or("");
  d.periods = record.integer("periods");
  d.realisations = record.integer("realisations");
  d.period = record.integer("period");
  d.dropped_samples = record.integer("dropped_samples");
  d.sample_rate_hz = record.number("sample_rate");
  d.degrees_of_freedom = record.number("degrees_of_freedom");
  d.correlated_lines = std::max<std::int64_t>(0, record.integer("correlated_lines").value_or(0));
  if (const auto largest = record.numbers("input_amplitude")) d.input_amplitude.assign(largest->begin(), largest->end());
  if (const auto warnings = record.texts("warnings")) d.warnings.assign(warnings->begin(), warnings->end());
}

Eigen::MatrixXd radius_of(const ResponseData& d) {
  if (d.confidence_radius.size() != 0) return d.confidence_radius;
  const double nu = d.degrees_of_freedom.value_or(std::numeric_limits<double>::infinity());
  return d.variance.unaryExpr([nu](double v) { return numerics::confidence_radius(v, nu, kConfidence); });
}

}  // namespace

Expected<ResponseData> read_response(const RecordView& record) {
  if (record.type() != "frequency_response")
    return unexpected("a record of type '" + std::string(record.type()) + "'; needed: frequency_response");
  ResponseData d;
  read_attributes(record, d);
  auto frequency = frequencies_of(record);
  if (!frequency) return unexpected(frequency.error().text);
  d.frequency_hz = std::move(*frequency);
  const Eigen::Index lines = d.frequency_hz.size();

  const auto response = record.array("response");
  if (!response) return unexpected("the record has no array 'response'");
  if (response->shape.size() != 3 || response->shape[0] != static_cast<std::uint64_t>(lines) || response->size == 0)
    return unexpected("array 'response' is " + shape_text(response->shape) + "; needed: " + std::to_string(lines) +
                      " x outputs x inputs");
  const auto outputs = static_cast<std::size_t>(response->shape[1]), inputs = static_cast<std::size_t>(response->shape[2]);
  d.input_names = names_of(record, "input_names", inputs, "input");
  d.output_names = names_of(record, "output_names", outputs, "output");
  d.response_units.assign(outputs * inputs, std::string(response->unit));
  if (const auto units = record.texts("response_units"); units && units->size() == outputs * inputs)
    d.response_units.assign(units->begin(), units->end());
  auto g = matrix_of<Complex>(*response, lines);
  if (!g) return unexpected(g.error().text);
  d.response = std::move(*g);

  if (const auto variance = record.array("variance")) {
    if (!std::equal(variance->shape.begin(), variance->shape.end(), response->shape.begin(), response->shape.end()))
      return unexpected("array 'variance' is " + shape_text(variance->shape) + ", 'response' " + shape_text(response->shape));
    auto v = matrix_of<double>(*variance, lines);
    if (!v) return unexpected(v.error().text);
    d.variance = std::move(*v);
    if (d.variance.minCoeff() < 0.0)
      return unexpected("array 'variance' has the negative value " + short_number(d.variance.minCoeff()));
  }
  if (const auto numbers = record.array("line");
      numbers && numbers->element == BF_I64 && numbers->size == static_cast<std::size_t>(lines)) {
    const auto values = numbers->as<std::int64_t>();
    d.lines.assign(values.begin(), values.end());
  }
  if (inputs == 1 && outputs == 1) {
    auto spectra = spectra_of(record, lines);
    if (!spectra) return unexpected(spectra.error().text);
    d.spectra = std::move(*spectra);
  }
  return d;
}

RecordBuilder write_response(const ResponseData& d) {
  RecordBuilder r("frequency_response");
  r.set("form", d.form);
  r.set("method", d.method);
  if (d.periods) r.set("periods", *d.periods);
  if (d.realisations) r.set("realisations", *d.realisations);
  if (d.sample_rate_hz) r.set("sample_rate", *d.sample_rate_hz);
  if (d.period) r.set("period", *d.period);
  if (d.dropped_samples) r.set("dropped_samples", *d.dropped_samples);
  r.set("input_names", d.input_names);
  r.set("output_names", d.output_names);
  r.set("response_units", d.response_units);
  r.set("warnings", d.warnings);
  r.set("correlated_lines", d.correlated_lines);
  if (!d.input_amplitude.empty()) r.set("input_amplitude", d.input_amplitude);
  const bool certain = d.variance.size() != 0;
  if (certain) r.set("confidence", kConfidence);
  if (certain && d.degrees_of_freedom) r.set("degrees_of_freedom", *d.degrees_of_freedom);

  const auto lines = static_cast<std::uint64_t>(d.frequency_hz.size());
  const std::string unit = common_unit(d.response_units);
  put<double>(r, "frequency", "Hz", std::array{lines}, d.frequency_hz);
  const std::array shape{lines, static_cast<std::uint64_t>(d.outputs()), static_cast<std::uint64_t>(d.inputs())};
  put<Complex>(r, "response", unit, shape, d.response);
  if (certain) {
    put<double>(r, "variance", squared_unit(unit), shape, d.variance);
    put<double>(r, "confidence_radius", unit, shape, radius_of(d));
  }
  if (!d.lines.empty()) {
    const auto numbers = r.array<std::int64_t>("line", "", std::array{lines});
    std::copy(d.lines.begin(), d.lines.end(), numbers.begin());
  }
  return r;
}

}  // namespace bodeflow::records
