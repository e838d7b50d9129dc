#include "frequency_response.hpp"

#include <algorithm>
#include <cmath>

#include "declared_timing.hpp"
#include "gain_start.hpp"
#include "records/response.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kTwoPi = 6.283185307179586;
// Records are compared with models up to this many times their last excited line.
constexpr double kBeyond = 1.25;

}  // namespace

void FrequencyResponseModel::describe(Describe& d) {
  d.id("residual.frequency_response")
      .summary("A black box: a measured frequency response as it is, up to a gain of each input.")
      .doc(
          "Takes a record `frequency_response` of one or more inputs. Between its lines the response runs straight in real and "
          "imaginary "
          "part; below the first and up to 1.25 times the last it stays that of the end. Its own noise counts as an error of the "
          "model: measure it longer than what it is compared with. It has no places: only effects of response can be added, and "
          "what "
          "is nonlinear shows as unexplained.");
  d.parameter("output", "").doc("name of the output of a record that has several");
  describe_timing(d, Hold::band_limited);
}

void FrequencyResponseModel::configure(const Parameters& p) {
  output_ = p.text("output");
  timing_ = read_timing(p);
}

void FrequencyResponseModel::use_model(const RecordView& record) {
  if (record.type() != "frequency_response")
    fail("frequency_response takes a record 'frequency_response', not '" + std::string(record.type()) + "'");
  const auto data = records::read_response(record);
  if (!data) fail("the model: " + data.error().text);
  const auto& names = data->output_names;
  std::string listed;
  for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
  const auto found = output_.empty() && names.size() == 1 ? names.begin() : std::find(names.begin(), names.end(), output_);
  if (found == names.end())
    fail(output_.empty() ? "the response has several outputs, " + listed + ": declare output"
                         : "the response has no output '" + output_ + "'; there are: " + listed);
  const Eigen::Index first = (found - names.begin()) * data->inputs();
  frequency_hz_.assign(data->frequency_hz.begin(), data->frequency_hz.end());
  response_.clear();
  for (Eigen::Index j = 0; j < data->inputs(); ++j) {
    const auto column = data->response.col(first + j);
    response_.emplace_back(column.begin(), column.end());
  }
}

std::vector<FitParameter> FrequencyResponseModel::parameters() const {
  return gain_parameters(static_cast<int>(inputs().size()));
}

std::vector<PlantInput> FrequencyResponseModel::inputs() const {
  std::vector<PlantInput> all;
  for (std::size_t j = 0; j < std::max<std::size_t>(response_.size(), 1); ++j) all.push_back({static_cast<int>(j), 0});
  return all;
}

std::vector<std::string> FrequencyResponseModel::conventions() const {
  std::vector<std::string> words = {
      "a measured response, taken as it is up to a gain of each input: only effects of response can be added, none inside the "
      "plant"};
  for (std::string& text : timing_words(timing_)) words.push_back(std::move(text));
  return words;
}

bool FrequencyResponseModel::covers(double frequency_hz) const {
  return !frequency_hz_.empty() && frequency_hz <= kBeyond * frequency_hz_.back();
}

std::complex<double> FrequencyResponseModel::value_at(std::size_t input, double frequency_hz) const {
  const auto& g = response_[input];
  if (frequency_hz <= frequency_hz_.front()) return frequency_hz > 0.0 ? g.front() : std::complex<double>(g.front().real(), 0.0);
  if (frequency_hz >= frequency_hz_.back()) return g.back();
  const auto above = std::upper_bound(frequency_hz_.begin(), frequency_hz_.end(), frequency_hz);
  const auto k = static_cast<std::size_t>(above - frequency_hz_.begin());
  const double share = (frequency_hz - frequency_hz_[k - 1]) / (frequency_hz_[k] - frequency_hz_[k - 1]);
  return g[k - 1] + share * (g[k] - g[k - 1]);
}

std::vector<std::vector<double>> FrequencyResponseModel::starts(std::span<const MeasuredResponse> measured) const {
  if (response_.empty()) fail("frequency_response needs a record 'frequency_response' at 'model' with the response itself");
  double last = 0.0;
  for (const MeasuredResponse& m : measured)
    for (const double f : m.frequency_hz) last = std::max(last, f);
  if (!covers(last))
    fail("the response of the model ends at " + short_text(frequency_hz_.back()) + " Hz, the records at " + short_text(last) +
         " Hz");
  return {gains_near(measured, static_cast<int>(response_.size()),
                     [this](int j, double f) { return value_at(static_cast<std::size_t>(j), f); })};
}

bool FrequencyResponseModel::response(const double* v, const double*, std::complex<double> s,
                                      std::complex<double>* matrix) const {
  const double frequency_hz = std::abs(s.imag()) / kTwoPi;
  if (!covers(frequency_hz)) return false;
  for (std::size_t j = 0; j < response_.size(); ++j) {
    const std::complex<double> g = v[j] * value_at(j, frequency_hz);
    matrix[j] = s.imag() < 0.0 ? std::conj(g) : g;
  }
  return true;
}

}  // namespace bodeflow::residual
