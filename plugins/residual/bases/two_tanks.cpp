#include "two_tanks.hpp"

#include <cmath>

#include "declared_timing.hpp"
#include "polynomial_start.hpp"

namespace bodeflow::residual {
namespace {

constexpr std::size_t kUpperOutlet = 2;
// Below this part of the working level the jet of an outlet is laminar in the model: its slope stays finite.
constexpr double kLaminar = 1e-3;

}  // namespace

void TwoTanks::describe(Describe& d) {
  d.id("residual.two_tanks")
      .summary("A pump fills the upper one of two equal tanks, which runs out into the lower one, whose level is measured.");
  d.doc(
      "dh1/dt = p u - a1 g(h1), dh2/dt = a1 g(h1) - a2 g(h2), both tanks of the same section, levels in the unit of the measured "
      "one. g(h) = h (linear), or Torricelli's g(h) = sqrt(h H) with the declared working level H, at which both have the same "
      "value: a1 and a2 are rates 1/s in both. The laminar rest below H / 1000 keeps its slope finite. The linear tanks can be "
      "exchanged (a1 and a2) without any change of the response; effects tell which is which. What an overflow loses leaves the "
      "system.");
  d.reference(
      "M. Schoukens, J. P. Noel, Three benchmarks addressing open challenges in nonlinear system identification, IFAC 2017");
  d.parameter("outflow", "torricelli").choices({"linear", "torricelli"}).doc("how the outflow follows the level");
  d.parameter("level", 1.0).above(0.0).doc("the working level H of Torricelli's law, in level_unit");
  d.parameter("level_unit", "m").doc("of the measured level");
  d.parameter("input_unit", "V").doc("of what drives the pump");
  describe_timing(d, Hold::zero_order);
}

void TwoTanks::configure(const Parameters& p) {
  torricelli_ = p.text("outflow") == "torricelli";
  level_ = p.number("level");
  level_unit_ = p.text("level_unit");
  input_unit_ = p.text("input_unit");
  timing_ = read_timing(p);
}

std::vector<FitParameter> TwoTanks::parameters() const {
  const std::string rate = level_unit_ + "/s";
  return {positive("pump", rate == input_unit_ + "/s" ? "1/s" : rate + "/" + input_unit_).says("rise of the level by the input"),
          positive("upper_outflow", "1/s"), positive("lower_outflow", "1/s")};
}

std::vector<Place> TwoTanks::places() const {
  const auto place = [this](const char* name, const char* kind) {
    Place p;
    p.name = name;
    p.kind = kind;
    p.stored_unit = level_unit_;
    p.reaction_unit = level_unit_ + "/s";
    return p;
  };
  std::vector<Place> all = {place("upper_tank", "tank"), place("lower_tank", "tank")};
  if (torricelli_) {
    all.push_back(place("upper_outlet", "outlet"));
    all.push_back(place("lower_outlet", "outlet"));
  }
  return all;
}

std::vector<std::string> TwoTanks::conventions() const {
  std::vector<std::string> words = timing_words(timing_);
  words.emplace_back("both tanks have the same section");
  if (torricelli_) words.push_back("outflow by Torricelli's law, rates at a level of " + short_text(level_) + " " + level_unit_);
  return words;
}

std::vector<std::vector<double>> TwoTanks::starts(std::span<const MeasuredResponse> measured) const {
  // p a1 / ((s + a1) (s + a2)): 1 / G = a2 / p + s (a1 + a2) / (p a1) + s^2 / (p a1)
  const auto numerator = [](std::complex<double>) { return std::complex<double>(1.0); };
  const MeasuredResponse lines = joined_lines(measured);
  if (lines.frequency_hz.empty()) fail("the records have no line with a response: nothing to start from");
  double sum = 0.0, product = 0.0, gain = 0.0;
  if (const auto d = denominator_near(measured, numerator, 2)) {
    sum = (*d)[1] / (*d)[2];
    product = (*d)[0] / (*d)[2];
    gain = 1.0 / (*d)[0];
  }
  if (!(sum > 0.0) || !(product > 0.0) || !(gain > 0.0)) {
    // Two equal tanks with the gain of the lowest line.
    const double f = lines.frequency_hz[lines.frequency_hz.size() / 2];
    gain = std::abs(lines.response[0]);
    sum = 2.0 * f;
    product = f * f;
  }
  const double half = 0.5 * sum, root = std::sqrt(std::max(half * half - product, 0.01 * half * half));
  const double fast = half + root, slow = product / fast;
  return {{gain * slow, fast, slow}, {gain * fast, slow, fast}};
}

bool TwoTanks::state_space(const double* v, const double* /*known*/, LinearPlant& plant) const {
  const double pump = v[0], upper = v[1], lower = v[2];
  if (!(upper > 0.0) || !(lower > 0.0) || !std::isfinite(pump + upper + lower)) return false;
  if (!torricelli_) {
    plant.resize(2, 1, 2);
    plant.A = {-upper, 0.0, upper, -lower};
    plant.E = {-1.0, 0.0, 0.0, -1.0};
    plant.Cs = {1.0, 0.0, 0.0, 1.0};
  } else {
    plant.resize(2, 1, 4);
    plant.E = {-1.0, 0.0, -1.0, 0.0, 0.0, -1.0, 1.0, -1.0};
    plant.Cs = {1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0};
  }
  plant.B = {pump, 0.0};
  plant.C = {0.0, 1.0};
  return true;
}

Reaction TwoTanks::react(const double* v, const double* /*known*/, std::size_t place, const Signals& signals) const {
  if (place < kUpperOutlet) return {};
  const double rate = place == kUpperOutlet ? v[1] : v[2], h = signals.stored, laminar = kLaminar * level_;
  if (h < laminar) {
    const double slope = rate * std::sqrt(level_ / laminar);
    return {slope * h, 0.0, slope};
  }
  const double root = std::sqrt(h * level_);
  return {rate * root, 0.0, 0.5 * rate * level_ / root};
}

}  // namespace bodeflow::residual
