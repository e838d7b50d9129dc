#pragma once

#include <memory>

#include "expected.hpp"
#include "model/simulate.hpp"
#include "sampled/record_input.hpp"
#include "sampled/stretch.hpp"

namespace bodeflow::residual {

/// What a model makes of a record's input with one set of values: stretch by stretch, from a state of its own each.
///
/// Plants without states are evaluated sample by sample; where derivatives are filtered, reactions of laws pass the same filter,
/// as the measured output did. All others are simulated. Effects in series and in parallel act through the spectrum of the
/// stretch, mirrored at its ends. An immittance needs an otherwise linear model that settles: its answer to the input comes from
/// the record's spectrum, its answer to the state is that of the base model. Maps of the output act last, from the first sample
/// of the stretch on.
class Prediction {
 public:
  /// Refers to its arguments, which have to outlive it. Errors: the model can't be computed with these values, or not on a
  /// record.
  static Expected<Prediction> make(const RecordInput& record, const JointModel& model, const Eigen::VectorXd& values);

  /// States that each stretch begins with; 0 where the model has none.
  Eigen::Index states() const { return states_; }
  /// The output follows the state in a straight line.
  bool linear() const { return !model_->base->has_laws() && !model_->has(Acts::law) && !model_->has(Acts::output); }
  /// Laws that the output follows with kinks, or with a memory.
  bool rough() const;
  /// Effects in series stand between state and output, which `free_response` leaves out.
  bool filters_state() const { return !by_spectrum_ && model_->has(Acts::series); }
  /// How far each sample of a stretch can tell about the state, 0 to 1: not at all those that an input before the record moves (a
  /// delay), in full those that are a sample time after it, in proportion between, so that nothing jumps where a delay passes
  /// whole samples; not the first half where effects in series keep something from before the stretch.
  Eigen::VectorXd certainty(const Stretch& stretch) const;
  /// The output (where `signals`: and flows and stored quantities) at the samples of a stretch from that state at its first one.
  Expected<Simulated> run(const Stretch& stretch, const Eigen::VectorXd& state, bool signals = false) const;
  /// samples x states: the answer of the base model to each state alone.
  Eigen::MatrixXd free_response(Eigen::Index samples) const;

 private:
  Prediction(const RecordInput& record, const JointModel& model, const Eigen::VectorXd& values)
      : record_(&record), model_(&model), values_(&values) {}

  Expected<void> answer_by_spectrum();
  void add_parallel();
  Simulated without_states(const Stretch& stretch) const;
  Expected<Simulated> simulated(const Stretch& stretch, const Eigen::VectorXd& state, bool signals) const;
  void apply_output_effects(const Stretch& stretch, Simulated& s) const;
  std::complex<double> factors(std::complex<double> s) const;
  const Eigen::MatrixXd& input() const { return own_input_.size() > 0 ? own_input_ : record_->values(); }
  const double* values_of(std::size_t addition) const { return model_->values_of(addition, *values_); }

  const RecordInput* record_;
  const JointModel* model_;
  const Eigen::VectorXd* values_;
  std::shared_ptr<Simulation> simulation_;  ///< where it is simulated
  Eigen::Index states_ = 0;
  bool by_spectrum_ = false;  ///< `added_` is all of the answer to the input
  Eigen::MatrixXd own_input_;
  Eigen::VectorXd added_;  ///< to the output at all samples; empty: nothing
};

}  // namespace bodeflow::residual
