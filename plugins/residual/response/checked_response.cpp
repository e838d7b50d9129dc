#include "checked_response.hpp"

#include <bodeflow/units.hpp>
#include <cmath>

#include "records/response_units.hpp"
#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

using records::counted;
using records::ResponseData;
using records::short_number;

std::string at(double frequency_hz) { return " at " + short_number(frequency_hz) + " Hz"; }

std::string wrong_shape(const ResponseData& r, const BaseModel& base) {
  if (r.outputs() != 1) return "it has " + counted(r.outputs(), "output") + "; needed: one, the one that the model describes";
  const auto inputs = static_cast<Eigen::Index>(base.inputs().size());
  if (r.inputs() != inputs) return "it has " + counted(r.inputs(), "input") + ", the base model " + counted(inputs, "input");
  for (const PlantInput& input : base.inputs())
    if (input.derivative != 0) return "the base model takes derivatives of its input, which need records in time";
  if (r.response.rows() != r.frequency_hz.size() || r.response.cols() != inputs)
    return "its response has " + std::to_string(r.response.rows()) + " x " + std::to_string(r.response.cols()) + " values for " +
           counted(r.frequency_hz.size(), "line");
  if (r.variance.size() != 0 && (r.variance.rows() != r.response.rows() || r.variance.cols() != inputs))
    return "its variance has another shape than its response";
  return {};
}

std::string wrong_lines(const ResponseData& r) {
  for (Eigen::Index k = 0; k < r.frequency_hz.size(); ++k) {
    const double f = r.frequency_hz[k];
    if (!std::isfinite(f) || f < 0.0) return "line " + std::to_string(k + 1) + " is at " + short_number(f) + " Hz";
    if (k == 0 || f > r.frequency_hz[k - 1]) continue;
    return std::string(f < r.frequency_hz[k - 1] ? "its lines are not in order: " : "a line is there twice: ") + short_number(f) +
           " Hz after " + short_number(r.frequency_hz[k - 1]) + " Hz";
  }
  return {};
}

std::string wrong_values(const ResponseData& r) {
  const bool floor = r.variance.size() != 0;
  for (Eigen::Index k = 0; k < r.response.rows(); ++k) {
    for (Eigen::Index j = 0; j < r.response.cols(); ++j) {
      const std::complex<double> g = r.response(k, j);
      if (!std::isfinite(g.real()) || !std::isfinite(g.imag())) return "its response is not finite" + at(r.frequency_hz[k]);
      if (floor && !(r.variance(k, j) > 0.0 && std::isfinite(r.variance(k, j))))
        return "its variance is " + short_number(r.variance(k, j)) + at(r.frequency_hz[k]) + "; allowed: finite, above 0";
      if (!floor && !(std::abs(g) > 0.0))
        return "its response is 0" + at(r.frequency_hz[k]) + ", and errors count relative to it where no variance is stated";
    }
  }
  return {};
}

/// Magnitudes or phases alone, which are no response.
std::string not_complex(const ResponseData& r) {
  for (const std::string& unit : r.response_units) {
    const auto parsed = parse_unit(unit);
    if (unit.empty() || !parsed) continue;
    if (parsed->dimension[6] != 0) return "it is in " + unit + "; needed: the complex response in the unit of output over input";
    const bool angle = same_dimension(unit, "rad");
    if (angle && r.response.imag().cwiseAbs().maxCoeff() <= 0.0)
      return "it is real and in " + unit + ", a phase alone; needed: the complex response";
  }
  return {};
}

/// Brings the response to the unit of the base model; why it can't.
std::string convert_unit(ResponseData& r, const BaseModel& base) {
  const std::string needed = base.response_unit();
  if (needed.empty()) {
    if (r.response_units.size() > 1 && records::common_unit(r.response_units).empty())
      return "its inputs have responses of different units, " + r.response_units.front() + " and " + r.response_units.back();
    return {};
  }
  for (std::size_t j = 0; j < r.response_units.size(); ++j) {
    std::string& unit = r.response_units[j];
    if (unit.empty()) return "it states no unit; the base model needs " + needed;
    if (!same_dimension(unit, needed))
      return "it is in " + unit + ", the base model needs " + needed + ": check what is declared, and which way round it is";
    const auto factor = bodeflow::convert("1 " + unit, needed);
    if (!factor) return factor.error().text;
    const auto column = static_cast<Eigen::Index>(j);
    r.response.col(column) *= *factor;
    if (r.variance.size() != 0) r.variance.col(column) *= *factor * *factor;
    unit = needed;
  }
  return {};
}

void drop_first_line(ResponseData& r) {
  const Eigen::Index rest = r.frequency_hz.size() - 1;
  r.frequency_hz = r.frequency_hz.tail(rest).eval();
  r.response = r.response.bottomRows(rest).eval();
  if (r.variance.size() != 0) r.variance = r.variance.bottomRows(rest).eval();
  if (!r.lines.empty()) r.lines.erase(r.lines.begin());
  r.confidence_radius.resize(0, 0);
  r.spectra.reset();
}

}  // namespace

Expected<ResponseData> checked_response(ResponseData r, const BaseModel& base) {
  if (const std::string what = wrong_shape(r, base); !what.empty()) return refused(what);
  if (const std::string what = wrong_lines(r); !what.empty()) return refused(what);
  if (r.frequency_hz.size() > 0 && r.frequency_hz[0] <= 0.0) drop_first_line(r);
  const std::size_t parameters = base.parameters().size();
  if (2 * r.response.size() <= static_cast<Eigen::Index>(parameters))
    return refused("it has " + counted(r.frequency_hz.size(), "line") + " above 0 Hz, too few for " +
                   counted(static_cast<Eigen::Index>(parameters), "parameter"));
  if (const std::string what = wrong_values(r); !what.empty()) return refused(what);
  if (const std::string what = not_complex(r); !what.empty()) return refused(what);
  if (const std::string what = convert_unit(r, base); !what.empty()) return refused(what);
  return r;
}

}  // namespace bodeflow::residual
