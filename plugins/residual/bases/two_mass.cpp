#include "two_mass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "declared_timing.hpp"
#include "polynomial_start.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
// Frequencies that are tried for resonance and antiresonance, and the most lines that they are compared with.
constexpr int kTried = 48;
constexpr std::size_t kCompared = 100;
// The last step of a number, and the part by which the distance has to fall, for a search to go on.
constexpr double kFinest = 2e-3, kNearer = 1e-6;
// Half a step of the frequencies that are tried first.
constexpr double kGridStep = 0.08;
// Part of the coupling's damping that stays there where a start has it in a bearing.
constexpr double kKept = 0.1;
// Damping ratios of elastic couplings.
constexpr double kRatios[] = {0.01, 0.06};

/// The response from torque to acceleration at some lines.
struct Acceleration {
  std::vector<double> omega, log_size;
};

/// What a response of two masses looks like: antiresonance (0: none) and resonance [rad/s], damping ratio of the antiresonance,
/// and the corner below which friction holds more than inertia.
struct Shape {
  double anti = 0.0, resonance = 0.0, ratio = 0.0, corner = 0.0;
  double log_gain = 0.0;  ///< of the response; the best one
  double off = 0.0;       ///< sum of the squares that are left
};

/// Fills in gain and distance: the logarithm of the response beside that of
///   gain s / (s + corner) (s^2 + 2 ratio anti s + anti^2) / (s^2 + 2 ratio resonance^2 / anti s + resonance^2),
/// the same damper in both; 1 for the numerator and `ratio` of the resonance without an antiresonance.
Shape compared(const Acceleration& a, Shape shape) {
  const double ratio = shape.anti > 0.0 ? shape.ratio * shape.resonance / shape.anti : shape.ratio;
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < a.omega.size(); ++i) {
    const Complex s(0.0, a.omega[i]);
    const Complex numerator =
        shape.anti > 0.0 ? s * s + 2.0 * shape.ratio * shape.anti * s + shape.anti * shape.anti : Complex(1.0);
    const Complex denominator = (s * s + 2.0 * ratio * shape.resonance * s + shape.resonance * shape.resonance);
    const double off = a.log_size[i] - std::log(std::abs(numerator * s / (denominator * (s + shape.corner))));
    sum += off;
    squares += off * off;
  }
  const double n = static_cast<double>(a.omega.size());
  shape.log_gain = sum / n;
  shape.off = squares - sum * sum / n;
  return shape;
}

/// The shape that is nearest in its neighbourhood: each number in turn a step up or down while that is nearer, then half the
/// step.
Shape refined(const Acceleration& a, Shape best) {
  for (double step = kGridStep; step > kFinest; step *= 0.5) {
    for (bool nearer = true; nearer;) {
      nearer = false;
      for (double Shape::*number : {&Shape::anti, &Shape::resonance, &Shape::ratio, &Shape::corner}) {
        for (const double factor : {std::exp(step), std::exp(-step)}) {
          Shape tried = best;
          tried.*number *= factor * (number == &Shape::ratio || number == &Shape::corner ? factor * factor : 1.0);
          tried = compared(a, tried);
          if (!(tried.off < best.off * (1.0 - kNearer)) || tried.anti >= tried.resonance) continue;
          best = tried;
          nearer = true;
        }
      }
    }
  }
  return best;
}

Place place(const char* name, const char* kind, const std::string& reaction_unit) {
  Place p;
  p.name = name;
  p.kind = kind;
  p.flow_unit = "rad/s";
  p.stored_unit = "rad";
  p.reaction_unit = reaction_unit;
  return p;
}

}  // namespace

void TwoMass::describe(Describe& d) {
  d.id("residual.two_mass")
      .summary("A motor and a load on an elastic coupling, from torque or current to one of their movements.");
  d.doc(
      "J1 dw1/dt = M - d1 w1 - k (q1 - q2) - c (w1 - w2), J2 dw2/dt = k (q1 - q2) + c (w1 - w2) - d2 w2. With a current and no "
      "torque constant all coefficients are in A: those in Nm over the torque constant. From the load alone the split of the "
      "viscous friction is not found: it is put to the motor. Effects act in both bearings and in the coupling.");
  d.parameter("input", "torque").choices({"torque", "current"}).doc("what is measured or commanded");
  d.parameter("torque_constant", 0.0).unit("Nm/A").range(0.0, 1e6).doc("of a current; 0: not known");
  d.parameter("output", "motor_angle")
      .choices({"motor_angle", "load_angle", "motor_speed", "load_speed"})
      .doc("what is measured");
  describe_timing(d, Hold::band_limited);
}

void TwoMass::configure(const Parameters& p) {
  current_ = p.text("input") == "current";
  torque_constant_ = p.number("torque_constant");
  if (!current_ && torque_constant_ > 0.0) fail("torque_constant belongs to a current; input is 'torque'");
  const std::string& output = p.text("output");
  load_ = output == "load_angle" || output == "load_speed";
  speed_ = output == "motor_speed" || output == "load_speed";
  timing_ = read_timing(p);
}

std::vector<FitParameter> TwoMass::parameters() const {
  const std::string effort = effort_unit();
  std::vector<FitParameter> all = {positive("motor_inertia", effort + "*s^2/rad"), positive("load_inertia", effort + "*s^2/rad"),
                                   positive("stiffness", effort + "/rad").says("of the coupling"),
                                   positive("coupling_damping", effort + "*s/rad"),
                                   positive("motor_damping", effort + "*s/rad").says("viscous friction of the motor")};
  if (!load_) all.push_back(positive("load_damping", effort + "*s/rad").says("viscous friction of the load"));
  return all;
}

std::vector<Place> TwoMass::places() const {
  return {place("motor_bearing", "bearing", effort_unit()), place("load_bearing", "bearing", effort_unit()),
          place("coupling", "coupling", effort_unit())};
}

std::vector<std::string> TwoMass::conventions() const {
  std::vector<std::string> words = timing_words(timing_);
  if (current_ && torque_constant_ <= 0.0) words.emplace_back("coefficients over the torque constant, in A");
  if (torque_constant_ > 0.0) words.push_back("torque constant " + short_text(torque_constant_) + " Nm/A");
  if (load_) words.emplace_back("all viscous friction at the motor: the load alone does not tell how it is split");
  return words;
}

std::vector<double> TwoMass::values(double anti, double resonance, double inertia, double damping_ratio, double corner) const {
  const double ratio = anti / resonance, motor = inertia * ratio * ratio, load = inertia - motor, friction = corner * inertia;
  std::vector<double> v = {motor, load, anti * anti * load, 2.0 * damping_ratio * anti * load, load_ ? friction : 0.5 * friction};
  if (!load_) v.push_back(0.5 * friction);
  return v;
}

std::vector<std::vector<double>> TwoMass::starts(std::span<const MeasuredResponse> measured) const {
  const MeasuredResponse lines = joined_lines(measured);
  const std::size_t count = lines.frequency_hz.size();
  if (count < 4) fail("the base model needs at least 4 excited lines, found " + std::to_string(count));
  Acceleration a;
  Complex low_acceleration, low_speed;
  for (std::size_t i = 0; i < count; i += 1 + count / kCompared) {
    const Complex s(0.0, kTwoPi * lines.frequency_hz[i]), speed = lines.response[i] * (speed_ ? Complex(1.0) : s);
    a.omega.push_back(s.imag());
    a.log_size.push_back(std::log(std::abs(s * speed) / effort_of_input()));
    if (3 * i > count) continue;
    low_acceleration += s * speed / std::abs(s * speed);
    low_speed += speed / std::abs(speed);
  }
  if (low_acceleration.real() < 0.0 && low_speed.real() < 0.0)
    fail("the output moves against the input at low frequencies: check the signs of the signals");
  const double lowest = a.omega.front(), highest = a.omega.back(), step = std::log(2.0 * highest / lowest) / (kTried - 1);
  const auto tried = [&](int i) { return lowest * std::exp(step * i); };
  Shape best;
  best.off = std::numeric_limits<double>::infinity();
  for (const double ratio : kRatios) {
    Shape nearest;
    nearest.off = best.off;
    for (int r = 1; r < kTried; ++r) {
      for (int z = load_ ? r - 1 : 0; z < r; ++z) {
        const Shape shape = compared(a, {load_ ? 0.0 : tried(z), tried(r), ratio, 0.05 * lowest});
        if (shape.off < nearest.off) nearest = shape;
      }
    }
    if (nearest.resonance > 0.0) best = refined(a, nearest);
  }
  if (!(best.resonance > 0.0)) fail("the response has no finite size at some of its lines");
  const double over = best.resonance * best.resonance / std::exp(best.log_gain);
  std::vector<std::vector<double>> found;
  if (load_) {
    for (const double share : {0.5, 0.2, 0.8})  // of the motor in the inertia
      found.push_back(values(best.resonance * std::sqrt(share), best.resonance, over, best.ratio, best.corner));
    return found;
  }
  // A resonance tells how much is damped, hardly where: in the coupling, at the load, at the motor.
  const std::vector<double> v = values(best.anti, best.resonance, over / (best.anti * best.anti), best.ratio, best.corner);
  const double motor = v[0], load = v[1], moved = (1.0 - kKept) * v[3] * (motor + load) * (motor + load) / (motor * load);
  found = {v, v, v};
  found[1][3] = found[2][3] = kKept * v[3];
  found[1][5] += moved * load / motor;
  found[2][4] += moved * motor / load;
  return found;
}

bool TwoMass::state_space(const double* v, const double* /*known*/, LinearPlant& plant) const {
  const double motor = v[0], load = v[1], k = v[2], c = v[3], motor_friction = v[4], load_friction = load_ ? 0.0 : v[5];
  if (!(motor > 0.0) || !(load > 0.0) || !(k > 0.0) || !(c >= 0.0) || !(motor_friction >= 0.0) || !(load_friction >= 0.0) ||
      !std::isfinite(k / motor + k / load))
    return false;
  // States: motor angle, deflection of the coupling, motor speed, load speed. Places: motor and load bearing, coupling.
  plant.resize(4, 1, 3);
  const double m = 1.0 / motor, l = 1.0 / load;
  plant.A = {0.0,
             0.0,
             1.0,
             0.0,  //
             0.0,
             0.0,
             1.0,
             -1.0,  //
             0.0,
             -k * m,
             -(motor_friction + c) * m,
             c * m,
             0.0,
             k * l,
             c * l,
             -(load_friction + c) * l};
  plant.B = {0.0, 0.0, effort_of_input() * m, 0.0};
  plant.E = {0.0, 0.0, 0.0,  //
             0.0, 0.0, 0.0,  //
             -m,  0.0, -m,   //
             0.0, -l,  l};
  plant.Cf = {0.0, 0.0, 1.0, 0.0,  //
              0.0, 0.0, 0.0, 1.0,  //
              0.0, 0.0, 1.0, -1.0};
  plant.Cs = {1.0, 0.0,  0.0, 0.0,  //
              1.0, -1.0, 0.0, 0.0,  //
              0.0, 1.0,  0.0, 0.0};
  if (speed_) {
    plant.C = {0.0, 0.0, load_ ? 0.0 : 1.0, load_ ? 1.0 : 0.0};
  } else {
    plant.C = {1.0, load_ ? -1.0 : 0.0, 0.0, 0.0};
  }
  return true;
}

}  // namespace bodeflow::residual
