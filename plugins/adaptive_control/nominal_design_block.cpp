#include "nominal_design_block.hpp"

#include <algorithm>
#include <cmath>

#include "block_settings.hpp"
#include "controller_record.hpp"
#include "critical_frequency.hpp"
#include "largest_bandwidth.hpp"

namespace bodeflow::adaptive_control {
namespace {

/// The first frequency at which the phase reaches -180 degrees; nothing where it does not.
std::optional<double> phase_crossing(const numerics::TransferFunction& plant, double delay_s, double sample_time) {
  constexpr int kGrid = 2000;
  std::vector<double> omega;
  for (int i = 0; i < kGrid; ++i) omega.push_back(3.14 / sample_time * std::pow(1e-3, 1.0 - (i + 1.0) / kGrid));
  const auto g = sampled_response(plant, delay_s, sample_time, omega);
  if (!g) return {};
  for (std::size_t i = 1; i < omega.size(); ++i) {
    if ((*g)[i].real() < 0.0 && (*g)[i - 1].imag() < 0.0 && (*g)[i].imag() >= 0.0) return omega[i];
  }
  return {};
}

}  // namespace

void NominalDesign::describe(Describe& d) {
  d.id("adaptive_control.nominal_design")
      .summary("Designs the RST controller of a known plant, says how good the loop is and what the demands should rather be.");
  d.doc(
      "`controller` has R, S, T with closed-loop poles, M_s, gain margin, the residual of the fit, S(1) / T(1) before scaling, "
      "the "
      "critical frequency by (7.2), and the largest bandwidth for which controller and loop are stable. `advice` follows section "
      "7.4 "
      "step by step and names demands that are too high.");
  d.reference("P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992, chapters 3 and 7");
  d.required<double>("sample_time").unit("s").above(0).doc("h");
  describe_frequencies(d);
  describe_structure(d);
  describe_desired(d);
  describe_plant(d, true);
  d.optional<double>("anti_alias").unit("rad/s").above(0).doc("bandwidth of the filter before the sampler");
  d.message_out(controller).record_type("controller");
  d.message_out(advice).record_type("design_advice");
}

void NominalDesign::configure(const Parameters& p) {
  structure_ = read_structure(p);
  structure_.sample_time = p.number("sample_time");
  desired_ = read_desired(p, structure_.n_r);
  bandwidth_ = p.number("desired.bandwidth");
  plant_ = read_plant(p);
  delay_s_ = p.number("plant.delay");
  knowledge_.order = static_cast<int>(plant_.denominator.size()) - 1;
  if (delay_s_ > 0.0) knowledge_.delay_s = delay_s_;
  knowledge_.omega_180 = phase_crossing(plant_, delay_s_, structure_.sample_time);
  if (p.has("anti_alias")) knowledge_.anti_alias = p.number("anti_alias");
}

void NominalDesign::finish(Io& io) {
  const auto response = value_or_fail(sampled_response(plant_, delay_s_, structure_.sample_time, structure_.omega));
  const auto g_m = value_or_fail(desired_points(desired_, structure_.sample_time, structure_.omega));
  const auto design =
      value_or_fail(RstDesign::make(structure_, g_m, value_or_fail(sampled_observer(desired_.a_o, structure_.sample_time))));
  RstResult result;
  if (!design.solve(response.data(), result)) fail("the least-squares fit has no solution with t0 > 0");
  const SampledPlant sampled = value_or_fail(sampled_plant(plant_, delay_s_, structure_.sample_time));
  const LoopQuality quality = value_or_fail(loop_quality(sampled, result.rst));
  const BandwidthLimit limit = value_or_fail(largest_bandwidth(structure_, desired_, response, sampled));
  const double at_points = sensitivity_at_points(design, result.rst, response.data());
  const Verdict verdict = judge(design, result, response.data(), AcceptanceLimits{});
  RecordBuilder r = controller_record(result.rst, structure_.sample_time);
  r.set("accepted", verdict.refusal == Refusal::none && quality.largest_pole < 1.0);
  r.set("reason", std::string(quality.largest_pole < 1.0 ? words_of(verdict.refusal) : "the closed loop is unstable"));
  r.set("largest_closed_loop_pole", quality.largest_pole);
  r.set("sensitivity", quality.sensitivity);
  r.set("gain_margin", quality.gain_margin);
  r.set("leftmost_controller_pole", quality.controller_pole);
  r.set("residual", result.residual);
  r.set("gain_ratio", result.gain_ratio);
  r.set("critical_frequency", value_or_fail(CriticalFrequency::make(desired_, structure_.sample_time)).estimate(result.rst));
  r.set("largest_stable_bandwidth", limit.factor * bandwidth_);
  const auto poles = r.array<std::complex<double>>("closed_loop_poles", "", {static_cast<std::uint64_t>(quality.poles.size())});
  std::copy(quality.poles.begin(), quality.poles.end(), poles.begin());
  io.emit(controller, r);
  DesignAdvice before = advice_before(structure_, desired_, knowledge_);
  const DesignAdvice after = advice_after(result, quality, at_points);
  before.notes.insert(before.notes.end(), after.notes.begin(), after.notes.end());
  before.warnings.insert(before.warnings.end(), after.warnings.begin(), after.warnings.end());
  RecordBuilder told("design_advice");
  told.set("in_order", before.notes);
  told.set("warnings", before.warnings);
  io.emit(advice, told);
}

}  // namespace bodeflow::adaptive_control
