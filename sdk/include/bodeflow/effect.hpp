#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/plant.hpp>
#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// How an effect acts. Effects of all kinds can be added to each other: pairs need no code.
enum class Acts {
  law,         ///< at a place: a reaction over flow and stored quantity; the plant is simulated
  immittance,  ///< at a place: an impedance, effort lost = Z(s) flow; the plant stays linear
  input,       ///< on the samples of the input, before the plant
  output,      ///< on the samples of the output, behind it
  series,      ///< multiplies the response from the input to the output
  parallel,    ///< adds a response from the first input to the output
  delay,       ///< the output comes later
  tone         ///< sinusoids of the output that the input does not make; amplitude and phase are fitted in every record
};

/// What is static about an effect, said in `static void describe(DescribeEffect&)`.
struct EffectDescription {
  std::string id;       ///< "family.name"; candidates go by `name`
  std::string summary;  ///< one sentence, for somebody who is no specialist
  std::string doc;      ///< law, assumptions, when it is wrong
  std::string references;
  Acts acts = Acts::law;
  std::vector<std::string> kinds;  ///< of places, for law and immittance
  std::size_t memory = 0;          ///< numbers that a law or a map keeps from step to step
  int steps_per_sample = 1;        ///< of the simulation, at least: more where a law changes within a sample
  bool rough = false;              ///< the law jumps or has corners
  bool nonstationary = false;      ///< depends on the time since the record began: skirts beside the lines
  bool memoryless_linear = false;  ///< the map of an input or output is a constant that is added: an offset
  /// Names of effects that no experiment of this kind tells apart from this one, and what would.
  std::vector<std::string> equivalents;
  std::string separation;

  std::string name() const { return id.substr(id.find('.') + 1); }
  /// The model with it is still linear and known in closed form.
  bool linear() const { return acts != Acts::law && acts != Acts::input && acts != Acts::output; }
};

/// The argument of an effect's `describe`.
class DescribeEffect {
 public:
  explicit DescribeEffect(EffectDescription& d) : d_(d) {}

  DescribeEffect& id(std::string_view text) { return d_.id = text, *this; }
  DescribeEffect& summary(std::string_view text) { return d_.summary = text, *this; }
  DescribeEffect& doc(std::string_view text) { return d_.doc = text, *this; }
  DescribeEffect& reference(std::string_view text) {
    if (!d_.references.empty()) d_.references += '\n';
    d_.references += text;
    return *this;
  }
  DescribeEffect& acts(Acts acts) { return d_.acts = acts, *this; }
  /// A law or an immittance at places of these kinds.
  DescribeEffect& acts(Acts acts, std::vector<std::string> kinds) {
    d_.acts = acts;
    d_.kinds = std::move(kinds);
    return *this;
  }
  DescribeEffect& memory(std::size_t numbers) { return d_.memory = numbers, *this; }
  DescribeEffect& steps_per_sample(int steps) { return d_.steps_per_sample = steps, *this; }
  DescribeEffect& rough() { return d_.rough = true, *this; }
  DescribeEffect& nonstationary() { return d_.nonstationary = true, *this; }
  /// A map that adds a constant, and nothing else.
  DescribeEffect& constant() { return d_.memoryless_linear = true, *this; }
  DescribeEffect& equivalent_to(std::vector<std::string> names, std::string_view separation) {
    d_.equivalents = std::move(names);
    d_.separation = separation;
    return *this;
  }

 private:
  EffectDescription& d_;
};

/// What is known before an effect is fitted: of the base model on the records, and of what it leaves.
struct Situation {
  std::string input_unit, output_unit;
  double sample_time_s = 0.0;
  double duration_s = 0.0;  ///< of the shortest record
  double input_peak = 0.0, input_rms = 0.0, output_peak = 0.0, output_rms = 0.0;
  double residual_mean = 0.0, residual_rms = 0.0;
  Place place;  ///< where it would act; empty for effects of input, output and response
  /// At the excited lines: the base model's response and what it leaves, (Y - Yhat) / U, with its standard deviation.
  std::vector<double> line_hz;
  std::vector<std::complex<double>> response, missing;
  std::vector<double> missing_std;
  std::vector<double> peaks_hz;  ///< tones between the lines, highest first
  std::vector<double> jumps_s;   ///< instants at which the residual changes its level or size, most distinct first
};

/// Something physical that a base model lacks and that a tracer can add to it. An effect is simulated inside the model: it never
/// sees the measured output. Its functions are pure: one object serves any number of simulations, on any thread. `p` are the
/// values of its parameters in the order of `parameters`.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Whether it can act there with these records; a reason why not, "" if it can.
  virtual std::string refuses(const Situation&) const { return {}; }
  virtual std::vector<FitParameter> parameters(const Situation& s) const = 0;
  /// Points from which the fit sets out, each with one value a parameter; at least one.
  virtual std::vector<std::vector<double>> starts(const Situation& s) const = 0;
  /// The effect with its values in words, as a part of a sentence: "dead time of the inverter, 10.80 V (+-0.04) lost against the
  /// current".
  virtual std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const = 0;

  /// Acts::law. The reaction at the end of the step. `memory` is what stood in `next` after the step before, zeros at the
  /// beginning; called several times a step with trial values, so `next` follows from the arguments alone.
  virtual Reaction react(const double* /*p*/, const Signals&, const double* /*memory*/, double* /*next*/) const { return {}; }
  /// Acts::input, Acts::output. The sample that takes the place of x, called once a sample in their order. `time_s` since the
  /// record began.
  virtual double map(const double* /*p*/, double x, double /*time_s*/, double* /*memory*/) const { return x; }
  /// Acts::immittance: Z(s). Acts::series: the factor. Acts::parallel: what is added, for a unit of the first input.
  virtual std::complex<double> transfer(const double* /*p*/, std::complex<double> /*s*/) const { return 1.0; }
  /// Acts::delay [s].
  virtual double delay_s(const double* /*p*/) const { return 0.0; }
  /// Acts::tone: the frequencies.
  virtual std::vector<double> tones_hz(const double* /*p*/) const { return {}; }
};

}  // namespace v0
}  // namespace bodeflow
