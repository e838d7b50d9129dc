#include "designer.hpp"

#include <cmath>

#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kToldDistance = 0.05;  // of the coefficients: a rate limit that holds back less is not worth a line in the log

std::string settings_error(const DesignerSettings& s) {
  if (s.ladder_steps < 1 || s.ladder_steps > 64) {
    return "ladder of " + std::to_string(s.ladder_steps) + " steps; allowed: 1 to 64";
  }
  if (!(s.ladder_ratio > 0.0 && s.ladder_ratio < 1.0)) return "ladder ratio " + text_of(s.ladder_ratio) + "; allowed: 0 to 1";
  if (!(s.rate > 0.0 && s.rate <= 1.0)) return "rate " + text_of(s.rate) + "; allowed: above 0, up to 1";
  if (s.pause < 0) return "pause after a retreat " + std::to_string(s.pause) + " samples; allowed: at least 0";
  if (!std::isfinite(s.start_gain)) return "start gain is not finite";
  return {};
}

void approach(Coefficients& used, const Coefficients& wanted, int n, double rate) {
  for (std::size_t i = 0; i <= static_cast<std::size_t>(n); ++i) used[i] += rate * (wanted[i] - used[i]);
}

double distance(const Coefficients& a, const Coefficients& b, int n, double& size) {
  double sum = 0.0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(n); ++i) {
    sum += std::abs(a[i] - b[i]);
    size += std::abs(b[i]);
  }
  return sum;
}

}  // namespace

Expected<Designer> Designer::make(const DesignerSettings& s) {
  const std::string error = settings_error(s);
  if (!error.empty()) return refused(error);
  const bool by_points = !s.desired_points.empty();
  Designer d;
  double factor = 1.0;
  for (int step = 0; step < (by_points ? 1 : s.ladder_steps); ++step, factor *= s.ladder_ratio) {
    const DesiredResponse desired = scaled(s.desired, factor);
    auto g_m = by_points ? Expected<std::vector<std::complex<double>>>(s.desired_points)
                         : desired_points(desired, s.structure.sample_time, s.structure.omega);
    if (!g_m) return refused(g_m.error().text);
    auto a_o = sampled_observer(desired.a_o, s.structure.sample_time);
    if (!a_o) return refused(a_o.error().text);
    auto design = RstDesign::make(s.structure, *g_m, *a_o);
    if (!design) return refused(design.error().text);
    d.ladder_.push_back(*design);
  }
  d.checks_ = s.checks;
  d.limits_ = s.limits;
  d.rate_ = s.rate;
  d.start_ = s.start;
  d.pause_ = s.pause;
  Rst degrees;
  degrees.n_r = s.structure.n_r;
  degrees.n_s = s.structure.n_s;
  degrees.n_t = d.ladder_[0].n_t();
  d.start_controller_ = proportional(s.start_gain, degrees);
  d.anti_windup_ = d.ladder_[0].observer();
  return d;
}

void Designer::watch(double y, double u_c, int at_limit) {
  using InUse = Watchdog::InUse;
  const InUse in_use = !adapted_ ? InUse::start_controller : paused_ > 0 ? InUse::start_controller_again : InUse::designed;
  const Watchdog::Finding found = watchdog_.step(y, u_c, at_limit, in_use);
  if (paused_ > 0) --paused_;
  if (found.departure != Departure::none) {
    departure_ = found.departure;
    paused_ = pause_;
    found_any_ = false;
    first_step_ = std::min(first_step_ + 2, ladder_.size() - 1);
  }
  tell(retreat_net_, paused_ > 0, Net::retreat, found.value, found.limit);
}

const Rst& Designer::step(const std::complex<double>* response) {
  const bool found = find(response);
  if (found) move();
  tell(ladder_net_, found && level_ > 0, Net::ladder, level_, 0.0);
  tell(kept_net_, !found && found_any_, Net::kept, verdict_.value, 0.0);
  tell(rate_net_, found && rate_ < 1.0 && distance_ > kToldDistance, Net::rate, distance_, rate_);
  adapted_ = adapted_ || (found_any_ && sample_ >= start_);
  ++sample_;
  return adapted_ && found_any_ && paused_ == 0 ? used_ : start_controller_;
}

std::int64_t Designer::acted(Net net) const {
  return net == Net::ladder    ? ladder_net_.acted()
         : net == Net::kept    ? kept_net_.acted()
         : net == Net::retreat ? retreat_net_.acted()
                               : rate_net_.acted();
}

/// The fastest demands that give an acceptable controller, as accepted_ and level_.
bool Designer::find(const std::complex<double>* response) {
  for (std::size_t step = first_step_; step < ladder_.size(); ++step) {
    Verdict verdict{Refusal::no_solution, 0.0};
    if (ladder_[step].solve(response, candidate_)) {
      verdict = checks_ ? judge(ladder_[step], candidate_, response, limits_) : Verdict{};
    }
    if (step == first_step_) verdict_ = verdict;
    if (verdict.refusal != Refusal::none) continue;
    accepted_ = candidate_;
    level_ = static_cast<int>(step);
    return true;
  }
  return false;
}

void Designer::move() {
  const Rst& wanted = accepted_.rst;
  double size = 0.0;
  const double apart = distance(used_.r, wanted.r, wanted.n_r, size) + distance(used_.s, wanted.s, wanted.n_s, size) +
                       distance(used_.t, wanted.t, wanted.n_t, size);
  const bool at_once = !found_any_ || !adapted_ || paused_ > 0;  // no designed controller is in use
  distance_ = at_once ? 0.0 : apart / size;
  if (at_once || rate_ == 1.0) {
    used_ = wanted;
  } else {
    approach(used_.r, wanted.r, wanted.n_r, rate_);
    approach(used_.s, wanted.s, wanted.n_s, rate_);
    approach(used_.t, wanted.t, wanted.n_t, rate_);
  }
  found_any_ = true;
}

void Designer::tell(NetState& state, bool acts, Net net, double value, double limit) {
  const NetState::Change change = state.step(acts);
  if (change == NetState::Change::none) return;
  log_.add({net, change == NetState::Change::begins, -1, sample_, value, limit, verdict_.refusal, departure_});
}

}  // namespace bodeflow::adaptive_control
