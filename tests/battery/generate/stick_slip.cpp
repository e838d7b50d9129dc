#include "generate/stick_slip.hpp"

#include <cmath>

#include "generate/integrate.hpp"

namespace battery {
namespace {

class Rubbing {
 public:
  Rubbing(const Oscillator& o, double friction, const Drive& d)
      : o_(o), friction_(friction), d_(d), h_(d.sample_time / static_cast<double>(kSubsteps)) {}

  double position() const { return x_[0]; }

  void substep(std::size_t n) {
    double at = 0.0;  // part of the substep that is done
    for (int events = 0; at < 1.0 && events < kMostEvents; ++events) at = direction_ == 0.0 ? stick(n, at) : slide(n, at);
  }

 private:
  static constexpr int kMostEvents = 8, kHalvings = 30;

  /// The force within a substep: the parabola through its beginning, middle and end.
  double force(std::size_t n, double c) const {
    const double a = input_at(d_, Between::smooth, n, 0.0), b = input_at(d_, Between::smooth, n, 0.5),
                 e = input_at(d_, Between::smooth, n, 1.0);
    return a * (2.0 * c - 1.0) * (c - 1.0) + 4.0 * b * c * (1.0 - c) + e * c * (2.0 * c - 1.0);
  }
  State<2> moved_by(std::size_t n, double from, double part) const {
    return runge_kutta(x_, part * h_, [&](double c, const State<2>& s) {
      const double f = force(n, from + c * part) - direction_ * friction_;
      return State<2>{s[1], (f - o_.damping * s[1] - o_.stiffness * s[0]) / o_.mass};
    });
  }
  double pull(std::size_t n, double c) const { return force(n, c) - o_.stiffness * x_[0]; }

  double slide(std::size_t n, double from) {
    const auto end = moved_by(n, from, 1.0 - from);
    if (end[1] * direction_ >= 0.0) {
      x_ = end;
      return 1.0;
    }
    double low = 0.0, high = 1.0 - from;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      (moved_by(n, from, middle)[1] * direction_ >= 0.0 ? low : high) = middle;
    }
    x_ = moved_by(n, from, high);
    x_[1] = 0.0;
    direction_ = 0.0;
    return from + high;
  }

  double stick(std::size_t n, double from) {
    const auto holds = [&](double c) { return std::abs(pull(n, c)) <= friction_; };
    if (holds(from)) {
      if (holds(1.0)) return 1.0;
      double low = from, high = 1.0;
      for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (holds(middle) ? low : high) = middle;
      }
      from = high;
    }
    direction_ = pull(n, from) > 0.0 ? 1.0 : -1.0;
    return from;
  }

  const Oscillator& o_;
  double friction_;
  const Drive& d_;
  double h_;
  State<2> x_{};
  double direction_ = 0.0;
};

}  // namespace

Series stick_slip(const Oscillator& o, double friction, const Drive& d) {
  Rubbing rubbing(o, friction, d);
  Series y(d.all_samples() * kSubsteps);
  for (std::size_t n = 0; n < y.size(); ++n) {
    y[n] = rubbing.position();
    rubbing.substep(n);
  }
  return y;
}

}  // namespace battery
