#include "crest_optimiser.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "limited_bfgs.hpp"
#include "peak_norm.hpp"

namespace bodeflow::generators {
namespace {

using Vector = std::vector<double>;

constexpr int kLowestPower = 2, kHighestPower = 9;  // p = 2^2 .. 2^9
// Evaluations for one p, at most: more of them change the peak by less than other starts do.
constexpr int kEvaluations = 100;
// A relative gain that ends the descent for one p.
constexpr double kGain = 1e-5;
// Standard deviations, in cycles, of the disturbances before further descents, in turn: a near one and nearly random phases.
constexpr std::array kDisturbances = {0.2, 0.5};

struct Found {
  Vector cycles;
  double peak = std::numeric_limits<double>::infinity();
};

// The phases of lowest peak on the way down from `cycles`. Counts the points computed.
class Descent {
 public:
  explicit Descent(PeakNorm& norm) : norm_(norm), gradient_(norm.lines()), trial_(norm.lines()), trial_gradient_(norm.lines()) {}

  Found operator()(Vector cycles) {
    best_ = Found();
    cycles_ = std::move(cycles);
    for (int power = kLowestPower; power <= kHighestPower; ++power) minimise(power);
    return best_;
  }
  std::size_t points() const { return points_; }

 private:
  void minimise(int power) {
    LimitedBfgs curvature;
    double value = evaluate(cycles_, power, gradient_);
    for (int left = kEvaluations; left > 0;) {
      const Vector direction = curvature.direction(gradient_);
      const double slope = dot(direction, gradient_);
      if (!(slope < 0)) return;
      double next = value;
      // Armijo's rule.
      for (double length = 1; left > 0; length *= 0.5) {
        for (std::size_t k = 0; k < trial_.size(); ++k) trial_[k] = cycles_[k] + length * direction[k];
        next = evaluate(trial_, power, trial_gradient_);
        --left;
        if (next <= value + 1e-4 * length * slope) break;
      }
      if (!(next < value)) return;
      curvature.add(difference(trial_, cycles_), difference(trial_gradient_, gradient_));
      std::swap(cycles_, trial_);
      std::swap(gradient_, trial_gradient_);
      if (value - next < kGain) return;
      value = next;
    }
  }

  double evaluate(const Vector& cycles, int power, Vector& gradient) {
    const double value = norm_.evaluate(cycles, power, gradient);
    points_ += norm_.points();
    if (norm_.peak() < best_.peak) best_ = {cycles, norm_.peak()};
    return value;
  }

  PeakNorm& norm_;
  Vector cycles_, gradient_, trial_, trial_gradient_;
  Found best_;
  std::size_t points_ = 0;
};

}  // namespace

std::size_t descent_points(std::span<const Line> lines) {
  return PeakNorm::points_for(lines) * static_cast<std::size_t>(kEvaluations + 1) * (kHighestPower - kLowestPower + 1);
}

std::vector<double> optimise_phases(std::span<const Line> lines, std::size_t points) {
  PeakNorm norm(lines);
  Descent descent(norm);
  Vector cycles;
  for (const Line& line : lines) cycles.push_back(line.phase_rad / (2 * std::numbers::pi));
  Found best = descent(cycles);
  numerics::Random random(1);
  for (std::size_t turn = 0; descent.points() < points; ++turn) {
    cycles = best.cycles;
    for (double& phase : cycles) phase += kDisturbances[turn % kDisturbances.size()] * random.normal();
    Found found = descent(cycles);
    if (found.peak < best.peak) best = std::move(found);
  }
  for (double& phase : best.cycles) phase = 2 * std::numbers::pi * (phase - std::nearbyint(phase));
  return best.cycles;
}

}  // namespace bodeflow::generators
