#pragma once

#include <vector>

#include "model/step_maps.hpp"

namespace bodeflow::residual {

/// How the time of a sample is divided.
struct StepGrid {
  int steps = 1;  ///< a sample
  int fine = 8;   ///< single steps that take the place of one, a power of two
  /// Double steps where the laws allow it; without, single steps alone.
  bool doubles = true;
  double sample_time_s = 0.0;
  double offset_s = 0.0;  ///< the sample is taken so long after the sample time began, 0 <= offset < sample time
};

/// A plant with laws on its way through time, step by step. Nothing is allocated after the constructor.
///
/// Within a double step reactions are parabolas through begin, middle and end, and the laws hold at middle and end: collocation
/// at Lobatto's points for the laws (Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed. 1996, section IV.5:
/// Lobatto IIIA with 3 stages, order 4, A-stable), while the linear part is exact. Where Newton's iteration does not settle, the
/// step is done again as `fine` single ones, in which the reaction of each place is found between bounds. Where a rough law bends
/// within the step, it is halved, and its halves again, down to 1/32 of a fine one: a jump moves what follows by as much as it
/// is off in time, so the answer to states and parameters would be a staircase.
class Stepper {
 public:
  Stepper(const StepPlan& plan, const StepGrid& grid);

  /// State (balanced), reactions and memories at the begin.
  void begin(const Eigen::VectorXd& state, const double* input, double time_s);
  const double* state() const { return x_.data(); }
  bool sound() const { return sound_; }

  /// One step, the number `step` of its sample time, from input u0 to u1 (held: u0 alone counts). `time_s` at its begin.
  /// True if a sample was taken: `sampled` holds it.
  bool advance(int step, const double* u0, const double* u1, double time_s);
  const double* sampled() const { return sample_.data(); }

 private:
  /// A step halved so many times.
  struct Level {
    StepMaps plain, sampled;
    int sample_part = 0;  ///< of the 2^level parts, the one within which the sample is taken
  };
  const Level& level(std::size_t halvings);
  void advance_part(std::size_t halvings, int part, const double* u0, const double* u1, double time_s, bool sample);
  bool advance_double(const StepMaps& maps, double time_s, bool sample);
  void advance_single(const StepMaps& maps, double time_s, bool sample);
  void load_part(const double* u0, const double* u1, int part, int parts);
  void advance_fine(const double* u0, const double* u1, double time_s, bool sample);
  void move_state(const StepMaps& maps, int signals, int unknown);
  Signals single_signals(std::size_t i, const StepMaps& maps, double time_s) const;
  template <int Places>
  bool settle_double(const StepMaps& maps, double time_s);
  template <int Places>
  double correct_double(int i, const StepMaps& maps, double time_s);
  bool bends() const;
  bool settle_single(const StepMaps& maps, double time_s);
  bool solve_place(std::size_t i, const StepMaps& maps, double time_s, double* change);
  void resettle(double time_s, const double* u);
  void keep_memory(const StepMaps& maps, double time_s);
  void keep_scale();
  void take_sample(const StepMaps& maps, int nodes);
  void load(const double* u0, const double* u1);

  StepPlan plan_;
  Laws laws_;
  StepGrid grid_;
  int n_, q_, k_;
  bool any_rough_ = false;
  bool feeds_through_ = false;  ///< inputs reach a place at once: reactions jump with them
  double within_s_ = 0.0;       ///< of the step in which the sample is taken
  std::vector<Level> levels_;
  StepMaps single_, single_sampled_;
  int sample_step_ = 0, sample_fine_ = 0;
  std::vector<double> gain_;                              ///< of each place in a single step
  std::vector<double> x_, v_, out_, w_, guess_, sample_;  ///< w_: at the begin, middle, end
  std::vector<double> last_;                              ///< reactions of the step before, for the prediction
  std::vector<double> scale_;                             ///< largest reaction so far of each place
  std::vector<double> memory_, next_, u_, ua_, ub_;
  bool predicts_ = false, sound_ = true;
};

}  // namespace bodeflow::residual
