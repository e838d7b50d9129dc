#include "response_record.hpp"

#include <algorithm>

namespace bodeflow::spectrum {
namespace {

bool is_one(const std::string& unit) { return unit.empty() || unit == "1"; }

std::string squared(const std::string& unit) {
  if (is_one(unit)) return unit;
  return unit.find_first_of("/* ^") == std::string::npos ? unit + "^2" : "(" + unit + ")^2";
}

/// The common unit, or "" where they differ.
std::string common(const std::vector<std::string>& units) {
  const bool same = std::count(units.begin(), units.end(), units.front()) == static_cast<std::ptrdiff_t>(units.size());
  return same ? units.front() : "";
}

/// Copies a matrix row by row, as records are; `shape` has as many elements as the matrix.
template <class T, class Matrix>
void put(RecordBuilder& record, const char* name, const std::string& unit, std::initializer_list<std::uint64_t> shape,
         const Matrix& m) {
  const auto data = record.array<T>(name, unit, shape);
  std::size_t at = 0;
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    for (Eigen::Index i = 0; i < m.cols(); ++i) data[at++] = m(k, i);
  }
}

}  // namespace

std::string ratio_unit(const std::string& above, const std::string& below) {
  if (is_one(below)) return above;
  if (above == below) return "1";
  const bool simple = below.find_first_of("/* ") == std::string::npos;
  return (is_one(above) ? "1" : above) + "/" + (simple ? below : "(" + below + ")");
}

RecordBuilder response_record(const Estimate& e, const Measurement& from) {
  const std::string& input_unit = from.units.front();
  const std::vector<std::string> output_units(from.units.begin() + 1, from.units.end());
  std::vector<std::string> ratio_units;
  for (const std::string& unit : output_units) ratio_units.push_back(ratio_unit(unit, input_unit));
  const std::string output_unit = common(output_units), unit = common(ratio_units);

  RecordBuilder r("frequency_response");
  r.set("form", from.form == Form::known_input ? "known_input" : "errors_in_variables");
  r.set("periods", e.periods);
  r.set("realisations", std::int64_t{1});
  r.set("sample_rate", from.rate.hz());
  r.set("period", from.period);
  r.set("dropped_samples", from.dropped_samples);
  r.set("input_names", std::vector<std::string>{from.names.front()});
  r.set("output_names", std::vector<std::string>(from.names.begin() + 1, from.names.end()));
  r.set("response_units", ratio_units);

  const auto lines = static_cast<std::uint64_t>(e.lines.size());
  const auto outputs = static_cast<std::uint64_t>(e.response.cols());
  const auto frequency = r.array<double>("frequency", "Hz", {lines});
  for (std::size_t k = 0; k < e.lines.size(); ++k) {
    frequency[k] = static_cast<double>(e.lines[k]) * static_cast<double>(from.rate.num) /
                   (static_cast<double>(from.rate.den) * static_cast<double>(from.period));
  }
  using Complex = std::complex<double>;
  put<Complex>(r, "response", unit, {lines, outputs, 1}, e.response);
  put<double>(r, "variance", squared(unit), {lines, outputs, 1}, e.variance);
  const auto numbers = r.array<std::int64_t>("line", "", {lines});
  std::copy(e.lines.begin(), e.lines.end(), numbers.begin());
  put<Complex>(r, "input_mean", input_unit, {lines, 1}, e.input_mean);
  put<double>(r, "input_variance", squared(input_unit), {lines, 1}, e.input_variance);
  put<Complex>(r, "output_mean", output_unit, {lines, outputs}, e.output_mean);
  put<double>(r, "output_variance", squared(output_unit), {lines, outputs}, e.output_variance);
  put<Complex>(r, "cross_covariance", "", {lines, outputs, 1}, e.cross_covariance);
  return r;
}

}  // namespace bodeflow::spectrum
