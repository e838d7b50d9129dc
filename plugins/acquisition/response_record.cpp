#include "response_record.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <bodeflow/units.hpp>
#include <cmath>

namespace bodeflow::acquisition {
namespace {

constexpr double kConfidence = 0.95;

std::string squared(const std::string& unit) {
  if (unit.empty() || unit == "1") return unit;
  return unit.find_first_of("/* ^") == std::string::npos ? unit + "^2" : "(" + unit + ")^2";
}

/// The unit that all elements have, or "".
std::string common_unit(const Response& r) {
  const bool same = std::count(r.units.begin(), r.units.end(), r.units.front()) == static_cast<std::ptrdiff_t>(r.units.size());
  return same ? r.units.front() : "";
}

}  // namespace

Expected<void> state_variance(Response& r, const ResponseCertainty& certainty) {
  if (!certainty.stated()) return {};
  if (!r.variance.empty()) return unexpected("the file has variances; leave deviation.relative and deviation.absolute away");
  for (const std::complex<double> g : r.value) {
    const double relative = certainty.relative_deviation * std::abs(g);
    r.variance.push_back(relative * relative + certainty.absolute_deviation * certainty.absolute_deviation);
  }
  return {};
}

Expected<void> state_unit(Response& r, const std::string& unit) {
  if (unit.empty()) return {};
  if (!is_known_unit(unit)) return unexpected("unit '" + unit + "' is not known");
  for (std::string& own : r.units) {
    if (!own.empty() && (!is_known_unit(own) || !same_unit(own, unit)))
      return unexpected("unit '" + unit + "', but the file says '" + own + "'");
    own = unit;
  }
  return {};
}

RecordBuilder response_record(const Response& r, const ResponseCertainty& certainty, const std::string& file) {
  RecordBuilder record("frequency_response");
  record.set("form", "imported");
  record.set("method", "file");
  record.set("file", file);
  record.set("format", r.format);
  record.set("input_names", r.input_names);
  record.set("output_names", r.output_names);
  record.set("response_units", r.units);
  record.set("warnings", r.warnings);
  record.set("variance_known", !r.variance.empty());
  const bool circles = !r.variance.empty() && certainty.degrees_of_freedom;
  if (circles) {
    record.set("degrees_of_freedom", *certainty.degrees_of_freedom);
    record.set("confidence", kConfidence);
  }
  const auto points = static_cast<std::uint64_t>(r.frequency_hz.size());
  const auto outputs = static_cast<std::uint64_t>(r.output_names.size()),
             inputs = static_cast<std::uint64_t>(r.input_names.size());
  const std::string unit = common_unit(r);
  std::copy(r.frequency_hz.begin(), r.frequency_hz.end(), record.array<double>("frequency", "Hz", {points}).begin());
  std::copy(r.value.begin(), r.value.end(),
            record.array<std::complex<double>>("response", unit, {points, outputs, inputs}).begin());
  if (!r.variance.empty()) {
    std::copy(r.variance.begin(), r.variance.end(),
              record.array<double>("variance", squared(unit), {points, outputs, inputs}).begin());
  }
  if (circles) {
    const auto radius = record.array<double>("confidence_radius", unit, {points, outputs, inputs});
    std::transform(r.variance.begin(), r.variance.end(), radius.begin(), [&](double variance) {
      return numerics::confidence_radius(variance, *certainty.degrees_of_freedom, kConfidence);
    });
  }
  return record;
}

}  // namespace bodeflow::acquisition
