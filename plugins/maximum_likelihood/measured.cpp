#include "measured.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "records/checksum.hpp"
#include "records/record_arrays.hpp"
#include "records/response.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

Expected<Eigen::Index> place_of(const std::string& name, const std::vector<std::string>& names, const char* what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<Eigen::Index>(found - names.begin());
  std::string allowed;
  for (const std::string& n : names) allowed += (allowed.empty() ? "'" : ", '") + n + "'";
  return refused(std::string(what) + " '" + name + "' is not in the response; it has " + allowed);
}

Expected<Eigen::Index> input_of(const records::ResponseData& data, const std::string& name) {
  if (!name.empty()) return place_of(name, data.input_names, "input");
  if (data.inputs() == 1) return Eigen::Index{0};
  std::string inputs;
  for (const std::string& n : data.input_names) inputs += (inputs.empty() ? "'" : ", '") + n + "'";
  return refused("the response has " + std::to_string(data.inputs()) + " inputs, a model has one; choose `input` among " +
                 inputs);
}

Expected<std::vector<Eigen::Index>> outputs_of(const records::ResponseData& data, const std::vector<std::string>& names) {
  std::vector<Eigen::Index> places;
  for (const std::string& name : names.empty() ? data.output_names : names) {
    const auto place = place_of(name, data.output_names, "output");
    if (!place) return refusal_in(place);
    if (std::find(places.begin(), places.end(), *place) != places.end()) return refused("output '" + name + "' is named twice");
    places.push_back(*place);
  }
  return places;
}

// An array as lines x outputs, if the record has it in that shape.
template <class T>
bool read_columns(const RecordView& record, const char* name, Eigen::Index lines, Eigen::Index columns,
                  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>& into) {
  const auto array = record.array(name);
  if (!array || array->size != static_cast<std::size_t>(lines * columns)) return false;
  auto read = records::matrix_of<T>(*array, lines);
  if (!read) return false;
  into = std::move(*read);
  return true;
}

// Mean spectra and covariances in place of the response.
bool take_mean_spectra(const RecordView& record, const records::ResponseData& data, const std::vector<Eigen::Index>& outputs,
                       Spectra& s) {
  if (data.inputs() != 1 || (data.form != "errors_in_variables" && data.form != "reference")) return false;
  const Eigen::Index lines = data.frequency_hz.size(), columns = data.outputs();
  Eigen::MatrixXcd u, y, covariance;
  Eigen::MatrixXd u_variance, y_variance;
  if (!read_columns(record, "input_mean", lines, 1, u) || !read_columns(record, "output_mean", lines, columns, y) ||
      !read_columns(record, "input_variance", lines, 1, u_variance) ||
      !read_columns(record, "output_variance", lines, columns, y_variance) ||
      !read_columns(record, "cross_covariance", lines, columns, covariance)) {
    return false;
  }
  s.input = u.col(0);
  s.input_variance = u_variance.col(0);
  s.output = y(Eigen::all, outputs);
  s.output_variance = y_variance(Eigen::all, outputs);
  s.covariance = covariance(Eigen::all, outputs);
  return true;
}

std::string checksum_of(const Spectra& s) {
  records::Checksum sum;
  const auto add = [&](const auto& m) { sum.add({m.data(), static_cast<std::size_t>(m.size())}); };
  add(s.omega_rad_s);
  const Eigen::MatrixXd parts[] = {s.input.real(), s.input.imag(), s.output.real(), s.output.imag(), s.output_variance};
  for (const Eigen::MatrixXd& part : parts) add(part);
  return sum.text();
}

}  // namespace

Expected<Measured> read_measured(const RecordView& record, const std::string& input, const std::vector<std::string>& outputs) {
  const auto data = records::read_response(record);
  if (!data) return refused(data.error().text);
  const auto column = input_of(*data, input);
  if (!column) return refusal_in(column);
  const auto rows = outputs_of(*data, outputs);
  if (!rows) return refusal_in(rows);

  Measured m;
  m.input_name = data->input_names[static_cast<std::size_t>(*column)];
  std::vector<Eigen::Index> entries;
  for (const Eigen::Index i : *rows) {
    entries.push_back(i * data->inputs() + *column);
    m.output_names.push_back(data->output_names[static_cast<std::size_t>(i)]);
    m.units.push_back(data->response_units[static_cast<std::size_t>(entries.back())]);
  }
  m.has_variance = data->variance.size() != 0 && data->variance(Eigen::all, entries).maxCoeff() > 0.0;
  const Eigen::MatrixXcd response = data->response(Eigen::all, entries);
  Eigen::MatrixXd variance = Eigen::MatrixXd::Zero(response.rows(), response.cols());
  if (m.has_variance) variance = data->variance(Eigen::all, entries);
  m.spectra = spectra_of(2.0 * std::numbers::pi * data->frequency_hz, response, variance);
  m.mean_spectra = m.has_variance && take_mean_spectra(record, *data, *rows, m.spectra);
  if (data->degrees_of_freedom && std::isfinite(*data->degrees_of_freedom))
    m.spectra.degrees_of_freedom = *data->degrees_of_freedom;
  if (data->sample_rate_hz && *data->sample_rate_hz > 0.0) m.spectra.sample_time_s = 1.0 / *data->sample_rate_hz;
  m.spectra.correlated_lines = data->correlated_lines;
  if (static_cast<Eigen::Index>(data->input_amplitude.size()) == data->inputs())
    m.input_amplitude = data->input_amplitude[static_cast<std::size_t>(*column)];
  if (const auto array = record.array("input_mean")) m.input_unit = array->unit;
  if (const auto array = record.array("output_mean")) m.output_unit = array->unit;
  m.checksum = checksum_of(m.spectra);
  return m;
}

}  // namespace bodeflow::maximum_likelihood
