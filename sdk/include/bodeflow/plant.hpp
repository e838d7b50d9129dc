#pragma once

#include <complex>
#include <limits>
#include <string>
#include <vector>

/// The words in which base models and effects speak of a plant: parameters, places, signals.
namespace bodeflow {
inline namespace v0 {

/// A parameter of a base model or an effect, moved by a fit.
struct FitParameter {
  std::string name;
  std::string unit;
  /// What physics allows; a fit that ends outside is no finding. A bound at 0 of an effect is where it vanishes.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  /// Fitted as its logarithm: positive by nature. Otherwise the fit may pass through 0, and the bounds judge the result.
  bool logarithmic = false;
  double scale = 1.0;        ///< a typical size of what is not fitted as a logarithm
  bool each_record = false;  ///< has a value of its own in every record, as a phase has
  std::string doc;

  FitParameter& positive() { return low = 0.0, logarithmic = true, *this; }
  FitParameter& between(double l, double h) { return low = l, high = h, *this; }
  FitParameter& size(double s) { return scale = s, *this; }
  FitParameter& own_in_each_record() { return each_record = true, *this; }
  FitParameter& says(std::string text) { return doc = std::move(text), *this; }
};

/// A parameter that is positive and fitted as its logarithm.
inline FitParameter positive(std::string name, std::string unit) {
  FitParameter p;
  p.name = std::move(name);
  p.unit = std::move(unit);
  return p.positive();
}

/// A parameter that may pass through 0; `size` is typical of it.
inline FitParameter real(std::string name, std::string unit, double size) {
  FitParameter p;
  p.name = std::move(name);
  p.unit = std::move(unit);
  return p.size(size);
}

/// A spot of a plant where something may be missing. What passes through is its flow (current, velocity), the integral of that
/// or what is stored there is `stored` (displacement, charge; in a core the flux linkage; in a tank the level); what an effect
/// adds is the reaction: the effort (voltage, force) that is lost there, in a core the extra magnetising current.
///
/// Kinds that effects of bodeflow know: `inverter`, `winding` (electric, flow is the current), `core` (stored is the flux
/// linkage, the reaction a current), `coil` (electric, an inductance with iron beside it), `bearing` (mechanic, flow is the
/// velocity, stored the position), `spring`, `coupling` (mechanic, stored is the deflection), `tank` (stored is the level, the
/// reaction an outflow). A third party may add kinds of its own.
struct Place {
  std::string name;  ///< "motor_bearing"
  std::string kind;
  std::string flow_unit, stored_unit, reaction_unit;
  /// Linear coefficient of the base model there (resistance, damping, stiffness, 1 / inductance), and the largest magnitudes with
  /// the base model on the records: filled in by the tracer before an effect sees the place.
  double coefficient = 0.0;
  double flow = 0.0;
  double stored = 0.0;
  double effort = 0.0;
};

/// What a law sees at its place, at the end of a step of the simulation.
struct Signals {
  double flow = 0.0;
  double stored = 0.0;
  double time_s = 0.0;  ///< since the record began
  double step_s = 0.0;
  /// By how much a unit of reaction lowers the flow within the step (>= 0). A law that jumps is spread over what it can change
  /// itself, |flow| < gain x jump: so it stops the flow and does not make it chatter.
  double gain = 0.0;
};

/// A reaction and its slopes. Slopes help the solver; near ones serve.
struct Reaction {
  double value = 0.0;
  double by_flow = 0.0;
  double by_stored = 0.0;
};

/// A linear plant with q inputs, one output and m places, w the reactions:
///   dx/dt = A x + B u + E w,   flow = Cf x + Df u + Ff w,   stored = Cs x + Ds u + Fs w,   y = C x + D u + F w
/// All matrices row-major; A n x n, B n x q, E n x m, Cf and Cs m x n, Df and Ds m x q, Ff and Fs m x m, C 1 x n, D 1 x q, F 1 x
/// m.
struct LinearPlant {
  int states = 0, inputs = 1, places = 0;
  std::vector<double> A, B, E, Cf, Df, Ff, Cs, Ds, Fs, C, D, F;

  /// Zeros of these sizes.
  void resize(int n, int q, int m) {
    states = n;
    inputs = q;
    places = m;
    const auto zeros = [](std::vector<double>& v, int rows, int columns) {
      v.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), 0.0);
    };
    zeros(A, n, n), zeros(B, n, q), zeros(E, n, m);
    zeros(Cf, m, n), zeros(Df, m, q), zeros(Ff, m, m);
    zeros(Cs, m, n), zeros(Ds, m, q), zeros(Fs, m, m);
    zeros(C, 1, n), zeros(D, 1, q), zeros(F, 1, m);
  }
};

/// A measured response between input j and the output: for starts.
struct MeasuredResponse {
  std::vector<double> frequency_hz;
  std::vector<std::complex<double>> response;
  std::vector<double> weight;  ///< one over its standard deviation
  std::vector<double> known;   ///< of that record
};

}  // namespace v0
}  // namespace bodeflow
