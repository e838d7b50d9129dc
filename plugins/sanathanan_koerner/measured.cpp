#include "measured.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "records/band.hpp"
#include "records/checksum.hpp"
#include "records/response.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

Expected<std::vector<Eigen::Index>> places_of(const std::vector<std::string>& wanted, const std::vector<std::string>& names,
                                              const char* what) {
  std::vector<Eigen::Index> places;
  for (const std::string& name : wanted.empty() ? names : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      std::string allowed;
      for (const std::string& n : names) allowed += (allowed.empty() ? "'" : ", '") + n + "'";
      return unexpected(std::string(what) + " '" + name + "' is not in the response; it has " + allowed);
    }
    places.push_back(static_cast<Eigen::Index>(found - names.begin()));
    if (std::count(places.begin(), places.end(), places.back()) > 1)
      return unexpected(std::string(what) + " '" + name + "' is named twice");
  }
  return places;
}

Expected<std::vector<Eigen::Index>> lines_in(const std::string& text, const records::ResponseData& r) {
  std::vector<Eigen::Index> lines;
  const auto band = records::parse_band(text, r.sample_rate_hz.value_or(0.0));
  if (!text.empty() && !band) return unexpected(band.error().text);
  for (Eigen::Index k = 0; k < r.frequency_hz.size(); ++k) {
    const double omega = 2.0 * std::numbers::pi * r.frequency_hz[k];
    if (text.empty() || (omega >= band->low_rad_s && omega <= band->high_rad_s)) lines.push_back(k);
  }
  if (lines.empty()) return unexpected("band '" + text + "' holds no line of the response");
  return lines;
}

Expected<void> weigh(Measured& m, const Selection& selection) {
  const bool certain = m.deviation.size() > 0 && m.deviation.maxCoeff() > 0.0;
  Weighting weighting = selection.weighting;
  if (weighting == Weighting::automatic)
    weighting = certain && m.deviation.minCoeff() > 0.0 ? Weighting::variance : Weighting::absolute;
  m.data.weights = Eigen::MatrixXd::Ones(m.data.lines(), 1);
  const auto refused = [&](const Eigen::MatrixXd& values, const std::string& what) -> Expected<void> {
    for (Eigen::Index k = 0; k < values.rows(); ++k) {
      if (!(values.row(k).minCoeff() > 0.0))
        return unexpected(what + " at line " + std::to_string(k + 1) + ": take `weighting: absolute`");
    }
    return {};
  };
  if (weighting == Weighting::variance) {
    if (m.deviation.size() == 0) return unexpected("weighting: variance needs a response with its variance; this one has none");
    if (auto good = refused(m.deviation, "weighting: variance, and the variance is zero"); !good) return good;
    m.data.weights = m.deviation.cwiseInverse();
  } else if (weighting == Weighting::relative) {
    const Eigen::MatrixXd size = m.data.response.cwiseAbs();
    if (auto good = refused(size, "weighting: relative, and the response is zero"); !good) return good;
    m.data.weights = size.cwiseInverse();
  }
  m.known_variance = weighting == Weighting::variance && !selection.tiers;
  if (selection.tiers) m.data.weights = tiered_weights(m.data.omega_rad_s, *selection.tiers).asDiagonal() * m.data.weights;
  return {};
}

std::string checksum_of(const Measured& m) {
  records::Checksum sum;
  const auto add = [&](const Eigen::MatrixXd& values) { sum.add({values.data(), static_cast<std::size_t>(values.size())}); };
  add(m.data.omega_rad_s);
  add(m.data.response.real());
  add(m.data.response.imag());
  add(m.deviation);
  return sum.text();
}

}  // namespace

Eigen::VectorXd tiered_weights(const Eigen::VectorXd& omega, const Tiers& t) {
  return omega.unaryExpr([&](double w) { return w < t.low_rad_s ? t.below : w > t.high_rad_s ? t.above : 1.0; });
}

Expected<Measured> read_measured(const RecordView& record, const Selection& selection) {
  const auto r = records::read_response(record);
  if (!r) return unexpected(r.error().text);
  const auto inputs = places_of(selection.inputs, r->input_names, "input");
  if (!inputs) return unexpected(inputs.error().text);
  const auto outputs = places_of(selection.outputs, r->output_names, "output");
  if (!outputs) return unexpected(outputs.error().text);
  const auto lines = lines_in(selection.band, *r);
  if (!lines) return unexpected(lines.error().text);

  Measured m;
  std::vector<Eigen::Index> entries;
  for (const Eigen::Index j : *inputs) {
    m.inputs.names.push_back(r->input_names[static_cast<std::size_t>(j)]);
    for (const Eigen::Index i : *outputs) entries.push_back(i * r->inputs() + j);
  }
  for (const Eigen::Index i : *outputs) m.outputs.names.push_back(r->output_names[static_cast<std::size_t>(i)]);
  m.inputs.units.resize(m.inputs.names.size());
  m.outputs.units.resize(m.outputs.names.size());
  for (const Eigen::Index e : entries) m.units.push_back(r->response_units[static_cast<std::size_t>(e)]);
  m.data.omega_rad_s = 2.0 * std::numbers::pi * r->frequency_hz(*lines);
  m.data.response = r->response(*lines, entries);
  if (r->variance.size() > 0 && r->variance(*lines, entries).maxCoeff() > 0.0)
    m.deviation = r->variance(*lines, entries).cwiseSqrt();
  if (auto good = weigh(m, selection); !good) return unexpected(good.error().text);
  if (auto good = check(m.data); !good) return unexpected(good.error().text);
  if (r->sample_rate_hz && *r->sample_rate_hz > 0.0) m.sample_time_s = 1.0 / *r->sample_rate_hz;
  if (r->degrees_of_freedom) m.degrees_of_freedom = *r->degrees_of_freedom;
  m.correlated_lines = r->correlated_lines;
  if (static_cast<Eigen::Index>(r->input_amplitude.size()) == r->inputs() && inputs->size() == 1)
    m.input_amplitude = r->input_amplitude[static_cast<std::size_t>(inputs->front())];
  m.checksum = checksum_of(m);
  return m;
}

}  // namespace bodeflow::sanathanan_koerner
