#include "stepped_sine_record.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <functional>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kSmallRatio = 10.0;  // 10 dB in power
constexpr std::int64_t kFewWindows = 4;
constexpr std::size_t kNamed = 5;

/// "2 of 60 frequencies (12 Hz, 15 Hz)", or "" where no line is meant.
std::string those(const std::vector<SteppedLine>& lines, const std::function<bool(const SteppedLine&)>& meant) {
  std::string names;
  std::size_t count = 0;
  for (const SteppedLine& line : lines) {
    if (!meant(line)) continue;
    if (++count <= kNamed) names += (count == 1 ? "" : ", ") + short_number(line.frequency_hz) + " Hz";
  }
  if (count == 0) return "";
  if (count > kNamed) names += ", ...";
  return std::to_string(count) + " of " + std::to_string(lines.size()) + (lines.size() == 1 ? " frequency (" : " frequencies (") +
         names + ")";
}

template <class Part>
auto column_of(const std::vector<SteppedLine>& lines, Part part) {
  using Value = std::decay_t<decltype(part(lines.front()))>;
  Eigen::Matrix<Value, Eigen::Dynamic, 1> column(static_cast<Eigen::Index>(lines.size()));
  for (std::size_t k = 0; k < lines.size(); ++k) column[static_cast<Eigen::Index>(k)] = part(lines[k]);
  return column;
}

/// lines x outputs of a vector with one entry an output.
template <class Vector>
auto rows_of(const std::vector<SteppedLine>& lines, Vector SineResponse::*part) {
  Eigen::Matrix<typename Vector::Scalar, Eigen::Dynamic, Eigen::Dynamic> m(static_cast<Eigen::Index>(lines.size()),
                                                                           (lines.front().response.*part).size());
  for (std::size_t k = 0; k < lines.size(); ++k) m.row(static_cast<Eigen::Index>(k)) = lines[k].response.*part;
  return m;
}

void put_numbers(RecordBuilder& record, const char* name, const std::vector<SteppedLine>& lines,
                 const std::function<std::int64_t(const SteppedLine&)>& part) {
  const auto data = record.array<std::int64_t>(name, "", {static_cast<std::uint64_t>(lines.size())});
  std::transform(lines.begin(), lines.end(), data.begin(), part);
}

void put_seconds(RecordBuilder& record, const char* name, const std::vector<SteppedLine>& lines, double SteppedLine::*part) {
  const auto data = record.array<double>(name, "s", {static_cast<std::uint64_t>(lines.size())});
  std::transform(lines.begin(), lines.end(), data.begin(), [part](const SteppedLine& line) { return line.*part; });
}

}  // namespace

std::vector<std::string> stepped_warnings(const std::vector<SteppedLine>& lines, const SteppedMeasurement& from) {
  std::vector<std::string> warnings;
  if (const auto found = those(lines, [](const auto& l) { return !l.settled; }); !found.empty()) {
    warnings.push_back(
        found +
        " had not settled when their time was over, and are biased by the transient: raise max_time (or the generator's dwell)");
  }
  const auto few = [](const SteppedLine& l) { return l.response.windows < kFewWindows; };
  if (const auto found = those(lines, few); !found.empty())
    warnings.push_back("fewer than " + std::to_string(kFewWindows) + " windows at " + found +
                       " give a variance that is itself uncertain: raise windows");
  const auto weak_input = [](const SteppedLine& l) {
    return std::norm(l.response.input_mean) < kSmallRatio * l.response.input_variance;
  };
  if (const auto found = those(lines, weak_input); !found.empty())
    warnings.push_back("the input stands less than 10 dB above its own noise at " + found +
                       ", which biases the response: raise the amplitude");
  for (std::size_t i = 0; i < from.outputs.names.size(); ++i) {
    const auto weak = [i](const SteppedLine& l) {
      const auto at = static_cast<Eigen::Index>(i);
      return std::norm(l.response.output_mean[at]) < kSmallRatio * l.response.output_variance[at];
    };
    if (const auto found = those(lines, weak); !found.empty()) {
      warnings.push_back("output '" + from.outputs.names[i] + "' stands less than 10 dB above its noise at " + found +
                         ": raise the amplitude or the windows");
    }
  }
  if (const auto measured = static_cast<std::int64_t>(lines.size()); measured < from.planned)
    warnings.push_back(std::to_string(measured) + " of " + std::to_string(from.planned) +
                       " frequencies were measured before the run ended: raise its duration");
  return warnings;
}

RecordBuilder stepped_record(std::vector<SteppedLine> lines, const SteppedMeasurement& from) {
  const std::vector<std::string> warnings = stepped_warnings(lines, from);
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.frequency_hz < b.frequency_hz; });
  const auto windows = [](const SteppedLine& l) { return l.response.windows; };
  ResponseData d;
  d.form = "stepped_sine";
  d.method = "spectrum.stepped_sine";
  d.input_names = from.input.names;
  d.output_names = from.outputs.names;
  d.response_units = response_units(from.outputs.units, from.input.units);
  d.warnings = warnings;
  d.realisations = 1;
  d.sample_rate_hz = from.rate.hz();
  d.periods = column_of(lines, windows).minCoeff();
  d.degrees_of_freedom = static_cast<double>(*d.periods - 1);
  d.frequency_hz = column_of(lines, [](const SteppedLine& l) { return l.frequency_hz; });
  d.response = rows_of(lines, &SineResponse::response);
  d.variance = rows_of(lines, &SineResponse::variance);
  d.confidence_radius = d.variance;
  for (Eigen::Index k = 0; k < d.variance.rows(); ++k) {
    const double nu = static_cast<double>(windows(lines[static_cast<std::size_t>(k)]) - 1);
    d.confidence_radius.row(k) =
        d.variance.row(k).unaryExpr([nu](double v) { return numerics::confidence_radius(v, nu, kConfidence); });
  }
  RecordBuilder r = write_response(d);
  put_numbers(r, "windows", lines, windows);
  put_numbers(r, "cycles", lines, [](const SteppedLine& l) { return l.cycles; });
  put_numbers(r, "window", lines, [](const SteppedLine& l) { return l.window; });
  put_numbers(r, "settled", lines, [](const SteppedLine& l) { return l.settled ? 1 : 0; });
  put_seconds(r, "settled_after", lines, &SteppedLine::settled_after_s);
  put_seconds(r, "dwell", lines, &SteppedLine::dwell_s);
  return r;
}

}  // namespace bodeflow::spectrum
