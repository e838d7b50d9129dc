#include "generate/case.hpp"

#include <cmath>
#include <stdexcept>

#include "generate/size.hpp"

namespace battery {
namespace {

// Sizes are log-uniform: effects of the catalogue from well below what can be seen, strangers only where they are visible.
constexpr double kSmallest = 0.02, kSmallestOutside = 0.3, kGreatest = 10.0;
// Beyond this part of the output the plant were another one.
constexpr double kGreatestPart = 0.25;

struct Noise {
  double rms = 0.0;
  double keep = 0.0;   ///< of the part that is not white: x[n] = keep x[n-1] + ...
  double white = 1.0;  ///< part of the variance that is white

  void add(Series& y, Random& random) const {
    double x = random.normal();
    for (double& v : y) {
      v += rms * (std::sqrt(white) * random.normal() + std::sqrt(1.0 - white) * x);
      x = keep * x + std::sqrt(1.0 - keep * keep) * random.normal();
    }
  }
};

Noise draw_noise(double rms, bool coloured, Random& random) {
  Noise n{rms, random.uniform(-0.6, 0.85), random.uniform(0.1, 0.6)};
  if (!coloured) n.white = 1.0;
  return n;
}

std::vector<Drive> draw_drives(const Plant& plant, Random& random) {
  const auto lines = leave_some_out(plant.line_choice(), random);
  std::vector<Drive> drives;
  for (const double level : {1.0, 0.45, 0.8, 0.9}) {
    drives.push_back(make_drive(lines, kPeriodSamples, plant.sample_time(), plant.input_rms(), level, random));
  }
  return drives;
}

template <class P>
Hidden make_hidden(const std::vector<Maker<P>>& makers, const std::string& name, const P& plant, const Scale& scale,
                   Random& random) {
  for (const auto& maker : makers) {
    if (maker.name == name) return maker.make(plant, scale, random);
  }
  throw std::invalid_argument("no effect '" + name + "'");
}

/// Outputs without noise; each record has random numbers of its own, the same in every call.
std::vector<Series> outputs_of(const Hidden& hidden, double strength, const std::vector<Drive>& drives, std::size_t count,
                               const std::string& seed) {
  std::vector<Series> outputs;
  for (std::size_t n = 0; n < count; ++n) {
    Random random(seed + "/hidden/" + std::to_string(n));
    outputs.push_back(hidden.run(drives[n], strength, random));
  }
  return outputs;
}

template <class P>
Case draw_on(const P& plant, const std::vector<Maker<P>>& makers, const Wish& wish, Random& random) {
  Case c;
  c.plant = plant.name();
  c.input_unit = plant.input_unit();
  c.output_unit = plant.output_unit();
  c.sample_time = plant.sample_time();
  c.kind = wish.kind;
  c.parameters = plant.parameters();
  const std::vector<Drive> drives = draw_drives(plant, random);
  const Series first = sampled(drives[0], plant.clean(drives[0]));
  const Scale scale{plant.input_rms(), root_mean_square(first), peak(first)};
  c.signal_to_noise = random.uniform(20.0, 40.0);
  c.noise = scale.output_rms * std::pow(10.0, -c.signal_to_noise / 20.0);
  c.coloured = random.chance(0.3);
  const Noise output_noise = draw_noise(c.noise, c.coloured, random);
  const Noise input_noise = draw_noise(scale.input_rms * std::pow(10.0, -random.uniform(20.0, 40.0) / 20.0), c.coloured, random);

  std::vector<Series> outputs;
  if (wish.kind == Kind::clean) {
    for (const Drive& d : drives) outputs.push_back(sampled(d, plant.clean(d)));
  } else {
    const Hidden hidden = make_hidden(makers, wish.effect, plant, scale, random);
    const double smallest = wish.kind == Kind::single ? kSmallest : kSmallestOutside;
    const double greatest = std::max(smallest, std::min(kGreatest, kGreatestPart * scale.output_rms / c.noise));
    const double wanted = c.noise * random.log_uniform(smallest, greatest);
    const std::vector<Drive> fitted(drives.begin(), drives.begin() + 2);
    const auto error = [&](double strength) {
      return model_error(plant, fitted, outputs_of(hidden, strength, drives, 2, wish.seed));
    };
    const Sized sized = strength_for(wanted, hidden.first, hidden.largest, error);
    c.effect = hidden.name;
    c.strength = sized.strength;
    c.size = sized.error / c.noise;
    c.values = hidden.values(sized.strength);
    outputs = outputs_of(hidden, sized.strength, drives, drives.size(), wish.seed);
  }
  const char* names[] = {"E1", "E2", "V", "T"};
  for (std::size_t n = 0; n < drives.size(); ++n) {
    CaseRecord r{names[n], drives[n], Series(drives[n].samples()), std::move(outputs[n])};
    for (std::size_t k = 0; k < r.input.size(); ++k) r.input[k] = drives[n].sample(k);
    if (plant.input_is_measured()) input_noise.add(r.input, random);
    output_noise.add(r.output, random);
    c.records.push_back(std::move(r));
  }
  return c;
}

template <class P>
std::vector<std::string> names_of(const std::vector<Maker<P>>& makers) {
  std::vector<std::string> names;
  for (const auto& maker : makers) names.push_back(maker.name);
  return names;
}

Case draw_once(const Wish& wish) {
  Random random(wish.seed);
  if (wish.plant == "motor") {
    const Motor motor = Motor::draw(random);
    return draw_on(motor, wish.kind == Kind::outside ? motor_strangers() : motor_effects(), wish, random);
  }
  if (wish.plant != "mechanical") throw std::invalid_argument("no plant '" + wish.plant + "'");
  const Oscillator oscillator = Oscillator::draw(random);
  return draw_on(oscillator, wish.kind == Kind::outside ? oscillator_strangers() : oscillator_effects(), wish, random);
}

}  // namespace

std::string word(Kind kind) { return kind == Kind::clean ? "clean" : kind == Kind::single ? "single" : "outside"; }

std::vector<std::string> effects_of(const std::string& plant, Kind kind) {
  if (kind == Kind::clean) return {};
  if (plant == "motor") return names_of(kind == Kind::single ? motor_effects() : motor_strangers());
  return names_of(kind == Kind::single ? oscillator_effects() : oscillator_strangers());
}

Case draw_case(const Wish& wish) {
  constexpr int kTries = 20;
  Wish trial = wish;
  Case c = draw_once(trial);
  // A stranger that this plant and this noise would hide is no test: another plant, other noise.
  for (int n = 1; n < kTries && c.kind == Kind::outside && c.size < 0.9 * kSmallestOutside; ++n) {
    trial.seed = wish.seed + "/" + std::to_string(n);
    c = draw_once(trial);
  }
  return c;
}

}  // namespace battery
