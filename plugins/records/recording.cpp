#include "recording.hpp"

#include <algorithm>

#include "record_arrays.hpp"

namespace bodeflow::records {
namespace {

Expected<Eigen::MatrixXd> samples_of(const RecordView& record, const char* name) {
  const auto array = record.array(name);
  if (!array) return unexpected("the record has no array '" + std::string(name) + "'");
  if (array->shape.size() != 2 || array->size == 0 || array->element != BF_F64)
    return unexpected("array '" + std::string(name) + "' is " + shape_text(array->shape) +
                      "; needed: channels x samples of numbers");
  const auto channels = static_cast<Eigen::Index>(array->shape[0]), samples = static_cast<Eigen::Index>(array->shape[1]);
  Eigen::MatrixXd m = Eigen::Map<const Eigen::MatrixXd>(array->as<double>().data(), samples, channels);
  for (Eigen::Index c = 0; c < channels; ++c)
    for (Eigen::Index n = 0; n < samples; ++n)
      if (!std::isfinite(m(n, c)))
        return unexpected("array '" + std::string(name) + "', channel " + std::to_string(c + 1) + ": sample " +
                          std::to_string(n) + " is not finite");
  return m;
}

Signals signals_in(const RecordView& record, const std::string& port, std::size_t channels) {
  Signals s;
  if (const auto names = record.texts(port + "_names")) s.names.assign(names->begin(), names->end());
  if (const auto units = record.texts(port + "_units")) s.units.assign(units->begin(), units->end());
  s.names.resize(channels, port);
  s.units.resize(channels);
  return s;
}

void put_samples(RecordBuilder& record, const char* name, const Signals& signals, const Eigen::MatrixXd& m) {
  const bool same = std::all_of(signals.units.begin(), signals.units.end(), [&](const auto& u) { return u == signals.units[0]; });
  const std::uint64_t shape[] = {static_cast<std::uint64_t>(m.cols()), static_cast<std::uint64_t>(m.rows())};
  const auto data = record.array<double>(name, same && !signals.units.empty() ? signals.units[0] : "", shape);
  std::copy(m.data(), m.data() + m.size(), data.begin());
}

}  // namespace

Expected<Recording> read_recording(const RecordView& record) {
  if (record.type() != "recording") return unexpected("a record of type '" + std::string(record.type()) + "'; needed: recording");
  Recording r;
  r.sample_rate_hz = record.number("sample_rate").value_or(0.0);
  if (!(r.sample_rate_hz > 0.0) || !std::isfinite(r.sample_rate_hz))
    return unexpected("attribute 'sample_rate' is missing or not above 0");
  r.period = record.integer("period").value_or(0);
  r.skip = record.integer("skip").value_or(0);
  r.periods = record.integer("periods").value_or(0);
  auto input = samples_of(record, "input"), output = samples_of(record, "output");
  if (!input) return unexpected(input.error().text);
  if (!output) return unexpected(output.error().text);
  r.input = std::move(*input);
  r.output = std::move(*output);
  if (r.input.rows() != r.output.rows())
    return unexpected("array 'input' has " + std::to_string(r.input.rows()) + " samples, 'output' " +
                      std::to_string(r.output.rows()));
  const bool fits = r.period >= 0 && r.skip >= 0 && r.periods >= 0 &&
                    (r.period == 0 || (r.skip <= r.samples() / r.period && r.periods <= r.samples() / r.period - r.skip));
  if (!fits)
    return unexpected("the record has " + std::to_string(r.samples()) + " samples, too few for " + std::to_string(r.skip) +
                      " + " + std::to_string(r.periods) + " periods of " + std::to_string(r.period));
  r.input_signals = signals_in(record, "input", static_cast<std::size_t>(r.input.cols()));
  r.output_signals = signals_in(record, "output", static_cast<std::size_t>(r.output.cols()));
  const auto lines = record.array("excited_line"), amplitudes = record.array("excited_amplitude");
  if (lines && amplitudes && lines->element == BF_I64 && amplitudes->element == BF_F64 && lines->size == amplitudes->size) {
    const auto k = lines->as<std::int64_t>();
    const auto a = amplitudes->as<double>();
    r.excited_lines.assign(k.begin(), k.end());
    r.excited_amplitudes.assign(a.begin(), a.end());
  }
  return r;
}

RecordBuilder write_recording(const Recording& r) {
  RecordBuilder record("recording");
  record.set("sample_rate", r.sample_rate_hz);
  record.set("period", r.period);
  record.set("skip", r.skip);
  record.set("periods", r.periods);
  record.set("input_names", r.input_signals.names);
  record.set("input_units", r.input_signals.units);
  record.set("output_names", r.output_signals.names);
  record.set("output_units", r.output_signals.units);
  put_samples(record, "input", r.input_signals, r.input);
  put_samples(record, "output", r.output_signals, r.output);
  if (!r.excited_lines.empty()) {
    const auto lines = record.array<std::int64_t>("excited_line", "", {r.excited_lines.size()});
    std::copy(r.excited_lines.begin(), r.excited_lines.end(), lines.begin());
    const auto amplitudes = record.array<double>("excited_amplitude", r.input_signals.units.at(0), {r.excited_amplitudes.size()});
    std::copy(r.excited_amplitudes.begin(), r.excited_amplitudes.end(), amplitudes.begin());
  }
  return record;
}

}  // namespace bodeflow::records
