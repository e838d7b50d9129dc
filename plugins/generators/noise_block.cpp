#include "noise_block.hpp"

#include "source.hpp"

namespace bodeflow::generators {
namespace {

// The width of a uniform distribution over its standard deviation: sqrt(12).
constexpr double kUniformWidth = 3.46410161513775458705;

}  // namespace

void Noise::describe(Describe& d) {
  d.id("generators.noise").summary("Gives seeded white noise.").role("source").realtime_safe().cost_ns(12);
  d.doc(
      "y[n] = mean + std e[n], e independent with mean 0 and variance 1. Each channel is a random stream of its own. The bits "
      "depend on the seed "
      "and on nothing else: neither chunks, threads nor the machine. Normal values stay within 8.3 std.");
  d.reference("D. Blackman, S. Vigna, Scrambled linear pseudorandom number generators (xoshiro256++), 2021, doi:10.1145/3460772");
  d.reference("M. J. Wichura, Algorithm AS 241: the percentage points of the normal distribution, 1988, doi:10.2307/2347330");
  describe_source(d);
  d.parameter("distribution", "normal").choices({"normal", "uniform"}).doc("of each sample, with the same mean and std");
  d.parameter("std", 1.0).unit("").range(0, 1e300).live().doc("standard deviation");
  d.parameter("mean", 0.0).unit("").live().doc("mean value");
  d.parameter("channels", std::int64_t{1}).range(1, 65536).doc("channels, independent of each other");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the noise; without it the run's seed and the block's name do");
  d.stream_out(out);
}

void Noise::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  channels_ = static_cast<int>(p.integer("channels"));
  normal_ = p.text("distribution") == "normal";
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
  change(p);
}

void Noise::resolve(Facts& f) {
  f.out(out) = source_facts(rate_, unit_, channels_);
  f.out(out).notes["noise.std"] = {level_.std};
}

void Noise::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  random_.assign(static_cast<std::size_t>(channels_), numerics::Random(0));
  reset();
}

void Noise::process(Io& io) {
  const double width = kUniformWidth * level_.std;
  for (std::size_t c = 0; c < random_.size(); ++c) {
    numerics::Random& random = random_[c];
    const auto y = io.write(out, static_cast<int>(c));
    if (normal_) {
      for (double& value : y) value = level_.mean + level_.std * random.normal();
    } else {
      for (double& value : y) value = level_.mean + width * (random.uniform() - 0.5);
    }
  }
}

void Noise::change(const Parameters& p) { level_ = {p.number("std"), p.number("mean")}; }

void Noise::reset() {
  for (std::size_t c = 0; c < random_.size(); ++c) random_[c] = numerics::Random::stream(seed_, c);
}

}  // namespace bodeflow::generators
