#include "model_block.hpp"

#include <bodeflow/units.hpp>
#include <cmath>
#include <numbers>

#include "model_record.hpp"
#include "sanathanan_koerner/model_record.hpp"

namespace bodeflow::subspace {
namespace {

constexpr std::int64_t kHighestOrder = 1000;
constexpr std::int64_t kMostFunctions = 2000;

std::optional<Eigen::Index> whole_or_auto(const std::string& name, const std::string& text, std::int64_t least,
                                          std::int64_t most) {
  if (text == "auto") return {};
  const auto value = convert(text, "1");
  if (!value || !(*value >= static_cast<double>(least) && *value <= static_cast<double>(most)) || *value != std::floor(*value))
    fail(name + ": '" + text + "'; allowed: " + std::to_string(least) + " to " + std::to_string(most) + ", or auto");
  return static_cast<Eigen::Index>(*value);
}

double frequency(const std::string& text) {
  const auto hertz = convert(text, "Hz"), angular = convert(text, "rad/s");
  const bool bare = convert(text, "1").has_value();
  const double value = bare ? 0.0 : hertz ? 2.0 * std::numbers::pi * *hertz : angular ? *angular : 0.0;
  if (!(value > 0.0) || !std::isfinite(value))
    fail("prewarp: '" + text + "'; allowed: bandwidth, scan, or a frequency above 0 with its unit, such as 20 Hz");
  return value;
}

Weighting weighting_named(const std::string& name) {
  if (name == "absolute") return Weighting::absolute;
  if (name == "relative") return Weighting::relative;
  return name == "variance" ? Weighting::variance : Weighting::automatic;
}

Stability stability_named(const std::string& name) {
  if (name == "none") return Stability::none;
  return name == "maciejowski" ? Stability::maciejowski : Stability::project;
}

}  // namespace

void ModelBlock::describe(Describe& d) {
  d.id("subspace.model")
      .summary("Identifies a state-space model of a frequency response by subspace projections, without iteration.")
      .role("identifier");
  d.doc(
      "The algorithm of McKelvey, Akcay and Ljung for any grid of lines, any number of inputs and outputs: the range of the "
      "observability matrix from an orthogonal projection, A and C from its shift, B and D by least squares. In orthonormal "
      "(Arnoldi) "
      "functions in place of powers of z, so that wide and narrow bands and high orders keep their digits; a few "
      "Sanathanan-Koerner iterations polish the result. Not the least-squares minimum: with few lines on a resonance, or with "
      "much noise, an iterative method is closer.");
  d.reference(
      "H. Akcay, S. M. Islam, B. Ninness, Subspace based identification of power transformer models from frequency response "
      "data, 1999");
  d.reference(
      "T. McKelvey, H. Akcay, L. Ljung, Subspace-based multivariable system identification from frequency response data, 1996, "
      "doi:10.1109/9.508900");
  d.message_in(response)
      .record_type("frequency_response")
      .doc("any number of inputs and outputs; the last that arrives is taken");
  d.message_in(repeat).record_type("frequency_response").optional().doc("the same measured again, to validate the order with");
  d.message_out(model).record_type("model").doc("at the end");
  d.message_out(order_scan).record_type("order_scan").doc("singular values and validation errors, where the order is sought");
  d.message_out(residual).record_type("residual").doc("what the model leaves, line by line");
  d.parameter("order", "auto").doc("number of states, or auto: by a clear gap of singular values, else by validation");
  d.parameter("highest_order", std::int64_t{40}).range(1, kHighestOrder).doc("of the search for the order");
  d.parameter("functions", "auto").doc("q, the count of basis functions (block rows), or auto: 40, or 20 more than the order");
  d.parameter("basis", "arnoldi").choices({"arnoldi", "powers"}).doc("powers: of z, as the paper has them; for comparison");
  d.parameter("stability", "project")
      .choices({"project", "maciejowski", "none"})
      .doc("of unstable poles: moved into the unit disc, damped by Maciejowski's matrix, or left");
  d.parameter("polish", std::int64_t{5}).range(0, 100).doc("Sanathanan-Koerner iterations at the end; 0: none");
  d.parameter("prewarp", "bandwidth")
      .doc("frequency of the bilinear map, such as 20 Hz; bandwidth: the highest one over pi; scan: that and three others");
  d.parameter("domain", "s").choices({"s", "z"}).doc("a model in s, or in z at the sample rate of the response");
  d.parameter("inputs", std::vector<std::string>{}).doc("names of the inputs of the model; default: all");
  d.parameter("outputs", std::vector<std::string>{}).doc("names of the outputs of the model; default: all");
  d.parameter("band", "").doc("frequencies that are fitted, as 1 Hz:50 Hz; default: all lines");
  d.parameter("weighting", "auto")
      .choices({"auto", "absolute", "relative", "variance"})
      .doc("of a line: 1, 1/|G|, or one over its standard deviation; auto: the last where the response has it, else the first");
}

void ModelBlock::configure(const Parameters& p) {
  Settings s;
  s.order = whole_or_auto("order", p.text("order"), 1, kHighestOrder);
  s.highest_order = p.integer("highest_order");
  s.functions = whole_or_auto("functions", p.text("functions"), 2, kMostFunctions);
  s.basis = p.text("basis") == "powers" ? Basis::powers : Basis::arnoldi;
  s.stability = stability_named(p.text("stability"));
  s.polish = static_cast<int>(p.integer("polish"));
  selection_.inputs = p.texts("inputs");
  selection_.outputs = p.texts("outputs");
  selection_.band = p.text("band");
  selection_.weighting = Weighting::absolute;
  weighting_ = weighting_named(p.text("weighting"));
  in_z_ = p.text("domain") == "z";
  const std::string& prewarp = p.text("prewarp");
  s.scan_prewarp = prewarp == "scan";
  prewarp_rad_s_.reset();
  if (prewarp != "scan" && prewarp != "bandwidth") prewarp_rad_s_ = frequency(prewarp);
  if (in_z_ && prewarp != "bandwidth") fail("prewarp is for domain: s; a model in z has its lines on the circle");
  settings_ = s;
}

void ModelBlock::receive(int port, const RecordView& record, Io&) {
  auto measured = sanathanan_koerner::read_measured(record, selection_);
  if (!measured) fail(measured.error().text);
  (port == response.index ? measured_ : repeated_) = std::move(*measured);
}

Plane ModelBlock::plane_for(const Lines& lines) const {
  if (!in_z_) return {prewarp_rad_s_.value_or(bandwidth_prewarp(lines.omega_rad_s)), 0.0};
  if (measured_->sample_time_s == 0.0) fail("domain: z needs a response with its sample rate");
  return {1.0, measured_->sample_time_s};
}

void ModelBlock::finish(Io& io) {
  if (!measured_) fail("no frequency response arrived");
  const auto lines = lines_of(*measured_, weighting_);
  if (!lines) fail(lines.error().text);
  std::optional<Lines> repeated;
  if (repeated_) {
    auto again = lines_of(*repeated_, weighting_);
    if (!again) fail("the repeated measurement: " + again.error().text);
    repeated = std::move(*again);
  }
  const auto found = identify(*lines, plane_for(*lines), settings_, repeated);
  if (!found) fail(found.error().text);
  // One weight a line is one over the deviation only where all entries have the same.
  const bool known_variance = measured_->data.channels() == 1 && measured_->deviation.size() > 0 &&
                              measured_->deviation.minCoeff() > 0.0 &&
                              (weighting_ == Weighting::variance || weighting_ == Weighting::automatic);
  Expected<ModelUncertainty> uncertainty = unexpected("it is that of a least-squares minimum; polish the model");
  if (settings_.polish > 0) uncertainty = uncertainty_of(*lines, found->model, known_variance);
  const std::vector<std::string> warnings = model_warnings(*found, uncertainty, settings_);
  io.emit(model, model_record(*found, *measured_, uncertainty, known_variance, warnings));
  if (found->scan) io.emit(order_scan, order_scan_record(*found->scan));
  io.emit(residual, sanathanan_koerner::residual_record(*measured_, found->model.response, "subspace.model"));
  for (const std::string& warning : warnings) log_warning(warning);
}

void ModelBlock::reset() {
  measured_.reset();
  repeated_.reset();
}

}  // namespace bodeflow::subspace
