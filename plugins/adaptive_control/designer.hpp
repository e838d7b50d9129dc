#pragma once

#include <cstdint>
#include <vector>

#include "acceptance.hpp"
#include "net_log.hpp"

namespace bodeflow::adaptive_control {

/// The design of every sample and its safety nets.
struct DesignerSettings {
  RstStructure structure;
  DesiredResponse desired;                           ///< A_m(s), A_o(s) and delay
  std::vector<std::complex<double>> desired_points;  ///< G_m at the points in place of A_m and the delay: a ladder of one step
  bool checks = true;                                ///< designs beyond `limits` are refused
  AcceptanceLimits limits;
  int ladder_steps = 12;  ///< demands tried: A_m and A_o slower by `ladder_ratio` each; 1: no ladder
  double ladder_ratio = 0.9;
  double rate = 0.1;        ///< share of the way to a new controller that a sample takes; 1: all of it
  std::int64_t start = 0;   ///< sample from which designed controllers are used
  double start_gain = 0.0;  ///< until then u = start_gain (u_c - y)
  int pause = 150;          ///< samples that the loop goes back to it after a retreat
};

/// Designs a controller at each sample and lets it through only if it is fit to run: demands that give no acceptable controller
/// are lowered step by step (`ladder`), a sample without any keeps the last controller, and a controller in use moves by a share
/// of its way, which keeps integral action and S(1) = T(1) as they are linear; until one is in use the newest is taken.
class Designer {
 public:
  /// Errors: those of RstDesign::make, desired_points and sampled_observer; settings outside their ranges.
  static Expected<Designer> make(const DesignerSettings& settings);

  /// The controller for this sample, from the plant's response at the points. Allocates nothing.
  const Rst& step(const std::complex<double>* response);

  /// Watches the loop, before `step`: a designed controller with which output or error leave all bounds, or the last control
  /// signal keeps running into its limits (-1, 1; else 0) while the command rests, is given up for the start controller for a
  /// while; demands are two steps of the ladder lower then.
  void watch(double y, double u_c, int at_limit = 0);

  /// Whether a designed controller is in use, or was.
  bool adapted() const { return adapted_; }
  /// The anti-windup polynomial: A_o(z) of the demands as given, times z^(n_R - n_T).
  const Coefficients& anti_windup() const { return anti_windup_; }
  const RstDesign& design(int step) const { return ladder_[static_cast<std::size_t>(step)]; }
  /// The last design that was accepted, and the ladder's step that gave it; -1 before the first.
  const RstResult& accepted() const { return accepted_; }
  int level() const { return level_; }
  /// Why the last sample's first demand was refused.
  Verdict verdict() const { return verdict_; }
  NetLog& log() { return log_; }
  /// Samples at which the ladder, the keeping and the rate limit acted.
  std::int64_t acted(Net net) const;

 private:
  bool find(const std::complex<double>* response);
  void move();
  void tell(NetState& state, bool acts, Net net, double value, double limit);

  std::vector<RstDesign> ladder_;
  bool checks_ = true;
  AcceptanceLimits limits_;
  double rate_ = 1.0;
  std::int64_t start_ = 0, sample_ = 0;
  Coefficients anti_windup_{};
  Rst used_, start_controller_;
  RstResult accepted_, candidate_;
  int level_ = -1;
  bool found_any_ = false, adapted_ = false;
  int pause_ = 0, paused_ = 0;
  std::size_t first_step_ = 0;
  Watchdog watchdog_;
  Departure departure_ = Departure::none;
  double distance_ = 0.0;
  Verdict verdict_;
  NetState ladder_net_, kept_net_, rate_net_, retreat_net_{1};
  NetLog log_;
};

}  // namespace bodeflow::adaptive_control
