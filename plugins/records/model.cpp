#include "model.hpp"

#include <cmath>
#include <complex>

#include "record_arrays.hpp"

namespace bodeflow::records {
namespace {

using Complex = std::complex<double>;

std::vector<std::string> texts_in(const RecordView& record, const char* name) {
  std::vector<std::string> texts;
  if (const auto given = record.texts(name)) texts.assign(given->begin(), given->end());
  return texts;
}

std::string first_text(const RecordView& record, const char* name, const std::string& otherwise) {
  const auto texts = texts_in(record, name);
  return texts.empty() ? otherwise : texts.front();
}

/// Names and units of all inputs or outputs, or nothing where there is one.
Signals several(const RecordView& record, const std::string& what) {
  Signals signals{texts_in(record, (what + "_names").c_str()), texts_in(record, (what + "_units").c_str())};
  if (signals.names.size() < 2) return {};
  signals.units.resize(signals.names.size());
  return signals;
}

/// As they are written: all of them, or the one.
Signals all_of(const Signals& several, const std::string& name, const std::string& unit) {
  return several.names.empty() ? Signals{{name}, {unit}} : several;
}

std::optional<Complex> logarithm(Complex z, double sample_time_s) {
  if (z == 0.0) return {};
  return std::log(z) / sample_time_s;
}

/// Roots in rad/s with their covariances: ds = dz / (z T).
void put_roots(RecordBuilder& record, const ModelData& m, const std::string& name, const Eigen::VectorXcd& roots,
               const std::vector<Eigen::Matrix2d>& covariance) {
  const bool discrete = m.sample_time_s > 0.0, certain = covariance.size() == static_cast<std::size_t>(roots.size());
  Eigen::VectorXcd s(roots.size());
  Eigen::MatrixXd spread(roots.size(), 4);
  for (Eigen::Index i = 0; i < roots.size(); ++i) {
    Eigen::Matrix2d slope = Eigen::Matrix2d::Identity();
    s[i] = roots[i];
    if (discrete) {
      const auto value = logarithm(roots[i], m.sample_time_s);
      s[i] = value.value_or(Complex(-INFINITY, 0.0));
      const Complex d = value ? 1.0 / (roots[i] * m.sample_time_s) : Complex(INFINITY, 0.0);
      slope << d.real(), -d.imag(), d.imag(), d.real();
    }
    if (!certain) continue;
    const Eigen::Matrix2d c = slope * covariance[static_cast<std::size_t>(i)] * slope.transpose();
    spread.row(i) << c(0, 0), c(0, 1), c(1, 0), c(1, 1);
  }
  put_list<Complex>(record, (name + "s").c_str(), "rad/s", s);
  if (discrete) put_list<Complex>(record, ("z_" + name + "s").c_str(), "", roots);
  if (!certain || roots.size() == 0) return;
  const std::uint64_t shape[] = {static_cast<std::uint64_t>(roots.size()), 2, 2};
  put<double>(record, (name + "_covariance").c_str(), "(rad/s)^2", shape, spread);
}

void put_numbers(RecordBuilder& r, const ModelData& m) {
  const auto set = [&](const char* name, const auto& value) {
    if (value) r.set(name, *value);
  };
  set("cost", m.cost);
  set("expected_cost", m.expected_cost);
  set("cost_degrees_of_freedom", m.cost_degrees_of_freedom);
  set("aic", m.aic);
  set("mdl", m.mdl);
  set("noise_ratio", m.noise_ratio);
  set("input_noise_variance", m.input_noise_variance);
  set("output_noise_variance", m.output_noise_variance);
  set("sample_rate", m.sample_rate_hz);
  set("samples", m.samples);
  set("input_amplitude", m.input_amplitude);
  if (m.band_hz) r.set("band", std::vector<double>{(*m.band_hz)[0], (*m.band_hz)[1]});
  if (!m.data_checksum.empty()) r.set("data_checksum", m.data_checksum);
}

void read_numbers(const RecordView& r, ModelData& m) {
  m.cost = r.number("cost");
  m.expected_cost = r.number("expected_cost");
  m.cost_degrees_of_freedom = r.number("cost_degrees_of_freedom");
  m.aic = r.number("aic");
  m.mdl = r.number("mdl");
  m.noise_ratio = r.number("noise_ratio");
  m.input_noise_variance = r.number("input_noise_variance");
  m.output_noise_variance = r.number("output_noise_variance");
  m.sample_rate_hz = r.number("sample_rate");
  m.samples = r.integer("samples");
  m.input_amplitude = r.number("input_amplitude");
  if (const auto band = r.numbers("band"); band && band->size() == 2) m.band_hz = Eigen::Vector2d((*band)[0], (*band)[1]);
  m.data_checksum = r.text("data_checksum").value_or("");
}

/// Roots as they were written: z where the record has them, else s.
Expected<Eigen::VectorXcd> roots_in(const RecordView& record, const std::string& name, bool discrete) {
  const std::string array = discrete ? "z_" + name : name;
  if (!record.array(array)) return Eigen::VectorXcd();
  return list_of<Complex>(record, array.c_str());
}

Expected<void> read_parameters(const RecordView& record, ModelData& m) {
  m.parameter_names = texts_in(record, "parameter_names");
  m.parameter_units = texts_in(record, "parameter_units");
  if (!record.array("parameters")) return {};
  auto parameters = list_of<double>(record, "parameters");
  if (!parameters) return unexpected(parameters.error().text);
  m.parameters = std::move(*parameters);
  const auto count = static_cast<std::size_t>(m.parameters.size());
  if (m.parameter_names.size() != count)
    return unexpected("attribute 'parameter_names' has " + std::to_string(m.parameter_names.size()) + " names for " +
                      std::to_string(count) + " parameters");
  m.parameter_units.resize(count);
  const auto covariance = record.array("covariance");
  if (!covariance) return {};
  if (covariance->shape.size() != 2 || covariance->shape[0] != count || covariance->shape[1] != count)
    return unexpected("array 'covariance' is " + shape_text(covariance->shape) + " for " + std::to_string(count) + " parameters");
  auto matrix = matrix_of<double>(*covariance, m.parameters.size());
  if (!matrix) return unexpected(matrix.error().text);
  m.covariance = std::move(*matrix);
  return {};
}

/// All but the system itself: how it was made, parameters, roots, names and figures.
Expected<ModelData> read_head(const RecordView& record) {
  if (record.type() != "model") return unexpected("a record of type '" + std::string(record.type()) + "'; needed: model");
  ModelData m;
  m.method = record.text("method").value_or("");
  m.form = record.text("form").value_or("");
  m.order = record.integer("order").value_or(0);
  m.sample_time_s = record.number("sample_time").value_or(0.0);
  m.delay_s = record.number("delay").value_or(0.0);
  if (!(m.sample_time_s >= 0.0) || !std::isfinite(m.sample_time_s) || !std::isfinite(m.delay_s))
    return unexpected("attributes 'sample_time' and 'delay' must be finite, the first not below 0");
  if (auto read = read_parameters(record, m); !read) return unexpected(read.error().text);
  auto poles = roots_in(record, "poles", m.sample_time_s > 0.0), zeros = roots_in(record, "zeros", m.sample_time_s > 0.0);
  if (!poles) return unexpected(poles.error().text);
  if (!zeros) return unexpected(zeros.error().text);
  m.poles = std::move(*poles);
  m.zeros = std::move(*zeros);
  m.input_name = first_text(record, "input_names", m.input_name);
  m.output_name = first_text(record, "output_names", m.output_name);
  m.input_unit = first_text(record, "input_units", "");
  m.output_unit = first_text(record, "output_units", "");
  m.inputs = several(record, "input");
  m.outputs = several(record, "output");
  m.conventions = texts_in(record, "conventions");
  m.warnings = texts_in(record, "warnings");
  read_numbers(record, m);
  return m;
}

Expected<void> read_transfer_function(const RecordView& record, ModelData& m) {
  auto numerator = list_of<double>(record, "numerator"), denominator = list_of<double>(record, "denominator");
  if (!numerator) return unexpected(numerator.error().text + "; a model of form '" + m.form + "' can't be read without it");
  if (!denominator) return unexpected(denominator.error().text + "; a model of form '" + m.form + "' can't be read without it");
  if (numerator->size() == 0 || denominator->size() == 0 || denominator->isZero(0.0))
    return unexpected("numerator and denominator need coefficients, the denominator one that is not 0");
  m.numerator = std::move(*numerator);
  m.denominator = std::move(*denominator);
  return {};
}

Expected<Eigen::MatrixXd> matrix_named(const RecordView& record, const char* name) {
  const auto array = record.array(name);
  if (!array) return unexpected("the record has array 'A' and no array '" + std::string(name) + "'");
  if (array->shape.size() != 2)
    return unexpected("array '" + std::string(name) + "' is " + shape_text(array->shape) + "; needed: a matrix");
  auto m = matrix_of<double>(*array, static_cast<Eigen::Index>(array->shape[0]));
  if (m && m->rows() == 0) m->resize(0, static_cast<Eigen::Index>(array->shape[1]));
  return m;
}

Expected<void> read_state_space(const RecordView& record, ModelData& m) {
  if (!record.array("A")) return {};
  auto A = matrix_named(record, "A"), B = matrix_named(record, "B"), C = matrix_named(record, "C"), D = matrix_named(record, "D");
  for (const auto* matrix : {&A, &B, &C, &D}) {
    if (!*matrix) return unexpected(matrix->error().text);
  }
  auto system = numerics::make_state_space(*A, *B, *C, *D, m.sample_time_s);
  if (!system) return unexpected(system.error().text);
  m.state_space = std::move(*system);
  return {};
}

}  // namespace

Expected<ModelData> read_model(const RecordView& record) {
  auto m = read_head(record);
  if (!m) return m;
  if (auto read = read_transfer_function(record, *m); !read) return unexpected(read.error().text);
  if (auto read = read_state_space(record, *m); !read) return unexpected(read.error().text);
  return m;
}

Expected<ModelData> read_linear_model(const RecordView& record) {
  auto m = read_head(record);
  if (!m) return m;
  if (!record.array("A") || record.array("denominator")) {
    if (auto read = read_transfer_function(record, *m); !read) return unexpected(read.error().text);
  }
  if (auto read = read_state_space(record, *m); !read) return unexpected(read.error().text);
  return m;
}

Expected<numerics::StateSpace> state_space_of(const ModelData& m) {
  if (m.state_space) return *m.state_space;
  auto made = numerics::to_state_space(numerics::TransferFunction{m.numerator, m.denominator, m.sample_time_s});
  if (!made) return unexpected(made.error().text);
  return std::move(*made);
}

RecordBuilder write_model(const ModelData& m) {
  RecordBuilder r("model");
  r.set("method", m.method);
  r.set("form", m.form);
  r.set("order", m.order);
  r.set("sample_time", m.sample_time_s);
  r.set("delay", m.delay_s);
  r.set("parameter_names", m.parameter_names);
  r.set("parameter_units", m.parameter_units);
  const Signals inputs = all_of(m.inputs, m.input_name, m.input_unit), outputs = all_of(m.outputs, m.output_name, m.output_unit);
  r.set("input_names", inputs.names);
  r.set("output_names", outputs.names);
  r.set("input_units", inputs.units);
  r.set("output_units", outputs.units);
  r.set("conventions", m.conventions);
  r.set("warnings", m.warnings);
  put_numbers(r, m);
  put_list<double>(r, "parameters", "", m.parameters);
  if (m.covariance.size() > 0) put_matrix(r, "covariance", "", m.covariance);
  if (m.denominator.size() > 0) {
    put_list<double>(r, "numerator", "", m.numerator);
    put_list<double>(r, "denominator", "", m.denominator);
  }
  if (m.state_space) {
    put_matrix(r, "A", "", m.state_space->A);
    put_matrix(r, "B", "", m.state_space->B);
    put_matrix(r, "C", "", m.state_space->C);
    put_matrix(r, "D", "", m.state_space->D);
  }
  if (m.denominator.size() == 0 && !m.state_space) return r;
  put_roots(r, m, "pole", m.poles, m.pole_covariance);
  // The zeros of several outputs are none of one list.
  if (m.denominator.size() > 0 || m.zeros.size() > 0) put_roots(r, m, "zero", m.zeros, m.zero_covariance);
  return r;
}

}  // namespace bodeflow::records
