#pragma once

#include <bodeflow/describe.hpp>
#include <bodeflow/parameters.hpp>
#include <bodeflow/plant.hpp>
#include <bodeflow/record_view.hpp>
#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// What the input does between its samples.
enum class Hold {
  zero_order,   ///< held over each sample: a command
  first_order,  ///< straight from sample to sample
  band_limited  ///< measured behind an anti-alias filter: what its spectrum says
};

/// How samples and the continuous plant belong together.
struct Timing {
  Hold hold = Hold::band_limited;
  double delay_s = 0.0;  ///< declared: from the sample of the input to the instant it acts
};

/// An input of the plant: a measured channel or its derivative of that order, filtered without phase.
struct PlantInput {
  int channel = 0;
  int derivative = 0;
};

/// What a plant is declared to be, with parameters to be fitted. A class that derives from it has a default constructor and
/// `static void describe(Describe&)`: id, summary, doc, references, and what can be declared as parameters; no ports. Configured,
/// it does not change any more, and its functions are pure: one object serves any thread. `v` are the values of `parameters`,
/// `known` the values of what `known` names, of the record at hand.
///
/// A model is given by `state_space`, or, where it has none (a fractional power of s), by `response`; the latter serves periodic
/// experiments without laws and measured responses.
class BaseModel {
 public:
  virtual ~BaseModel() = default;

  /// The values that its description declares.
  virtual void configure(const Parameters&) {}
  /// A model record handed to the tracer, for a black box that takes one. Throws Failure.
  virtual void use_model(const RecordView&) { fail("this base model takes no model"); }

  virtual std::vector<FitParameter> parameters() const = 0;
  virtual std::vector<Place> places() const { return {}; }
  /// What each record may state: names such as "added_mass", with a unit; 0 where a record says nothing.
  virtual std::vector<FitParameter> known() const { return {}; }
  virtual std::vector<PlantInput> inputs() const { return {PlantInput{}}; }
  /// Where derivatives are formed: the corner of the low-pass filter, applied forth and back to input and output; 0: none.
  virtual double filter_hz() const { return 0.0; }
  virtual Timing timing() const { return {}; }
  /// Unit of the output over the first input where physics fixes its dimension ("ohm"): records with another are refused; "":
  /// any.
  virtual std::string response_unit() const { return {}; }
  /// What is declared beside the parameters (hold, delay, which input), in words.
  virtual std::vector<std::string> conventions() const { return {}; }

  /// Parameters near the data, from which a fit sets out, the best guess first. Throws Failure for data that this model can't
  /// describe at all.
  virtual std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const = 0;

  /// Fills the plant; false outside of the domain of the parameters, or where there is no state space.
  virtual bool state_space(const double* /*v*/, const double* /*known*/, LinearPlant&) const { return false; }
  virtual bool has_state_space() const { return true; }
  /// Row-major (1 + places) x (inputs + places): output and flows by inputs and reactions at s; false outside of the domain.
  virtual bool response(const double* /*v*/, const double* /*known*/, std::complex<double> /*s*/,
                        std::complex<double>* /*matrix*/) const {
    return false;
  }
  /// A law that belongs to the model itself: the reaction at place `place` (without memory).
  virtual bool has_laws() const { return false; }
  virtual Reaction react(const double* /*v*/, const double* /*known*/, std::size_t /*place*/, const Signals&) const { return {}; }
};

}  // namespace v0
}  // namespace bodeflow
