#include "run_responses.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "records/signals.hpp"
#include "sweep_quantities.hpp"

namespace bodeflow::validation {
namespace {

using Complex = std::complex<double>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// runs x columns of an array, or nothing where it has another shape.
std::optional<Rows> rows_of(const RecordView& sweep, const char* name, Eigen::Index runs) {
  const auto array = sweep.array(name);
  if (!array || array->element != BF_F64 || array->shape.size() != 2 || array->shape[0] != static_cast<std::uint64_t>(runs) ||
      array->size == 0)
    return std::nullopt;
  return Eigen::Map<const Rows>(array->as<double>().data(), runs, static_cast<Eigen::Index>(array->shape[1]));
}

/// A number of each run; `otherwise` where they state none.
Eigen::VectorXd numbers_of(const RecordView& sweep, const char* name, Eigen::Index runs, double otherwise) {
  const auto array = sweep.array(name);
  if (!array || array->element != BF_F64 || array->shape.size() != 1 || array->size != static_cast<std::size_t>(runs))
    return Eigen::VectorXd::Constant(runs, otherwise);
  return Eigen::Map<const Eigen::VectorXd>(array->as<double>().data(), runs);
}

Expected<Eigen::VectorXd> frequencies(const FrequencyGrid& grid, double nyquist_hz) {
  const bool discrete = std::isfinite(nyquist_hz);
  const double last = grid.last_hz.value_or(nyquist_hz);
  const double first = grid.first_hz.value_or(last / static_cast<double>(grid.count));
  if (!(last > first) || !(first > 0.0))
    return unexpected("frequency: the grid from " + records::short_number(first) + " to " + records::short_number(last) +
                      " Hz does not rise from above 0");
  if (discrete && last > nyquist_hz * (1.0 + 1e-9))
    return unexpected("frequency.last: " + records::short_number(last) + " Hz is above half the sample rate of the models, " +
                      records::short_number(nyquist_hz) + " Hz");
  if (grid.logarithmic)
    return Eigen::VectorXd(Eigen::VectorXd::LinSpaced(grid.count, std::log(first), std::log(last)).array().exp());
  return Eigen::VectorXd(Eigen::VectorXd::LinSpaced(grid.count, first, last));
}

records::ResponseData described(const RecordView& sweep, Eigen::Index runs) {
  records::ResponseData d;
  d.form = "monte_carlo";
  d.method = "validation.monte_carlo";
  const auto name = [&](const char* attribute, const char* otherwise) {
    const auto texts = sweep.texts(attribute);
    return std::string(texts && texts->size() == 1 ? texts->front() : otherwise);
  };
  d.input_names = {name("input_names", "input")};
  d.output_names = {name("output_names", "output")};
  d.response_units = records::response_units({name("output_units", "")}, {name("input_units", "")});
  d.realisations = runs;
  d.degrees_of_freedom = static_cast<double>(runs - 1);
  return d;
}

/// Mean and variance over the rows: runs x lines.
void average(const Eigen::MatrixXcd& runs, records::ResponseData& d) {
  const Eigen::RowVectorXcd mean = runs.colwise().sum() / static_cast<double>(runs.rows());
  d.response = mean.transpose();
  d.variance = (runs.rowwise() - mean).cwiseAbs2().colwise().sum().transpose() / static_cast<double>(runs.rows() - 1);
}

Expected<std::optional<records::ResponseData>> of_models(const RecordView& sweep, Eigen::Index runs, const FrequencyGrid& grid) {
  const auto numerator = rows_of(sweep, "numerator", runs), denominator = rows_of(sweep, "denominator", runs);
  if (!numerator || !denominator) return std::optional<records::ResponseData>();
  const Eigen::VectorXd sample_time = numbers_of(sweep, "sample_time", runs, 0.0), delay = numbers_of(sweep, "delay", runs, 0.0);
  const double slowest = sample_time.maxCoeff();
  if (!(slowest > 0.0) && !grid.last_hz) return std::optional<records::ResponseData>();
  const auto f = frequencies(grid, slowest > 0.0 ? 0.5 / slowest : std::numeric_limits<double>::infinity());
  if (!f) return unexpected(f.error().text);

  records::ResponseData d = described(sweep, runs);
  d.frequency_hz = *f;
  Eigen::MatrixXcd responses(runs, f->size());
  for (Eigen::Index r = 0; r < runs; ++r) {
    const Eigen::VectorXd b = numerator->row(r), a = denominator->row(r);
    for (Eigen::Index k = 0; k < f->size(); ++k) {
      const Complex s(0.0, 2.0 * std::numbers::pi * (*f)[k]), x = sample_time[r] > 0.0 ? std::exp(s * sample_time[r]) : s;
      responses(r, k) = numerics::evaluate(b, x) / numerics::evaluate(a, x) * std::exp(-s * delay[r]);
    }
  }
  if (!responses.allFinite()) return std::optional<records::ResponseData>();
  average(responses, d);
  return std::optional(std::move(d));
}

Expected<std::optional<records::ResponseData>> of_responses(const RecordView& sweep, Eigen::Index runs) {
  const auto frequency = rows_of(sweep, "frequency", runs);
  const auto response = sweep.array("response");
  if (!frequency || !response || response->element != BF_C64 || response->shape.size() != 4 || response->shape[2] != 1 ||
      response->shape[3] != 1 || response->size != static_cast<std::size_t>(frequency->size()) ||
      (frequency->rowwise() - frequency->row(0)).cwiseAbs().maxCoeff() > 0.0)
    return std::optional<records::ResponseData>();
  using ComplexRows = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXcd responses = Eigen::Map<const ComplexRows>(response->as<Complex>().data(), runs, frequency->cols());
  if (!responses.allFinite()) return std::optional<records::ResponseData>();
  records::ResponseData d = described(sweep, runs);
  if (!response->unit.empty()) d.response_units = {std::string(response->unit)};
  d.frequency_hz = frequency->row(0).transpose();
  average(responses, d);
  return std::optional(std::move(d));
}

}  // namespace

Expected<std::optional<records::ResponseData>> run_responses(const RecordView& sweep, const FrequencyGrid& grid) {
  const auto runs = sweep_runs(sweep);
  if (!runs) return unexpected(runs.error().text);
  if (*runs < 2) return std::optional<records::ResponseData>();
  if (sweep.array("response")) return of_responses(sweep, *runs);
  return of_models(sweep, *runs, grid);
}

}  // namespace bodeflow::validation
