#include "coloured_noise_block.hpp"

#include <cmath>

#include "shaping_filter.hpp"
#include "source.hpp"

namespace bodeflow::generators {
namespace {

Eigen::VectorXd polynomial(const std::vector<double>& coefficients) {
  return Eigen::Map<const Eigen::VectorXd>(coefficients.data(), static_cast<Eigen::Index>(coefficients.size()));
}

constexpr std::size_t kMostCoefficients = 65;

}  // namespace

void ColouredNoise::describe(Describe& d) {
  d.id("generators.coloured_noise")
      .summary("Gives seeded noise of a stated spectrum.")
      .role("source")
      .realtime_safe()
      .cost_ns(30);
  d.doc(
      "White normal noise through a filter: H(z) = numerator / denominator in descending powers of z (so a moving average e[n] + "
      "0.5 e[n-1] is "
      "[1, 0.5] over [1, 0]), or a power law, 1 / f^exponent in power from `lowest` up to half of the sample rate, flat below "
      "`lowest`, made of "
      "three poles and zeros a decade (Plaszczynski 2007): within 0.6 dB from three times `lowest` to a fifth of the sample "
      "rate, and up to "
      "4 dB more power close to half of it. The level is the standard deviation `std` of the stream, from the filter's "
      "covariance, or "
      "`density`, the one-sided amplitude density at `density_at`. The states begin with the covariance that they have after a "
      "long time, so "
      "the noise is stationary from the first sample.");
  d.reference("S. Plaszczynski, Generating long streams of 1/f^alpha noise, 2007, doi:10.1142/S0219477507003635");
  describe_source(d);
  d.optional<std::vector<double>>("numerator")
      .unit("")
      .doc("of H, descending powers of z; 1 where only the denominator is given");
  d.optional<std::vector<double>>("denominator")
      .unit("")
      .doc("of H, descending powers of z; its roots inside of the unit circle");
  d.optional<double>("exponent").unit("1").above(0).doc("of the power law, at most 2, in place of numerator and denominator");
  d.optional<double>("lowest").unit("Hz").above(0).doc("from where on the power law holds");
  d.parameter("std", 1.0).unit("").range(0, 1e300).doc("standard deviation");
  d.optional<double>("density").unit("").range(0, 1e300).doc(
      "in place of std: amplitude density at density_at, in the stream's unit per root hertz");
  d.optional<double>("density_at").unit("Hz").range(0, kMaxRateHz).doc("frequency of that density");
  d.parameter("mean", 0.0).unit("").doc("mean value");
  d.parameter("channels", std::int64_t{1}).range(1, 65536).doc("channels, independent of each other");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the noise; without it the run's seed and the block's name do");
  d.stream_out(out);
}

void ColouredNoise::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  channels_ = static_cast<int>(whole(p, "channels", 1, 65536));
  mean_ = p.number("mean");
  own_seed_ = p.has("seed");
  seed_ = own_seed_ ? static_cast<std::uint64_t>(p.integer("seed")) : 0;
  take_filter(p);
  take_level(p);
}

void ColouredNoise::take_filter(const Parameters& p) {
  const bool rational = p.has("numerator") || p.has("denominator");
  if (rational == p.has("exponent")) fail("one of numerator and denominator, or exponent, must be given");
  if (p.has("exponent") != p.has("lowest")) fail("exponent and lowest belong together");
  if (rational) {
    const std::vector<double> one = {1.0};
    const std::vector<double> above = p.has("numerator") ? p.numbers("numerator") : one;
    const std::vector<double> below = p.has("denominator") ? p.numbers("denominator") : one;
    if (std::max(above.size(), below.size()) > kMostCoefficients)
      fail("the noise filter has " + std::to_string(std::max(above.size(), below.size())) + " coefficients, allowed: up to " +
           std::to_string(kMostCoefficients));
    filter_ = valid(rational_filter(polynomial(above), polynomial(below)));
    return;
  }
  const double exponent = p.number("exponent"), lowest = p.number("lowest") / rate_.hz();
  if (!(exponent > 0 && exponent <= 2)) fail("exponent is " + std::to_string(exponent) + ", allowed: above 0, at most 2");
  if (!(lowest >= 1e-9 && lowest < 0.5)) {
    fail("lowest is " + hertz(p.number("lowest")) + ", allowed: " + hertz(1e-9 * rate_.hz()) + " to half of the sample rate, " +
         hertz(0.5 * rate_.hz()));
  }
  filter_ = power_law_filter(exponent, lowest);
}

void ColouredNoise::take_level(const Parameters& p) {
  const Eigen::MatrixXd covariance = stationary_covariance(filter_);
  const double std = output_std(filter_, covariance);
  if (!(std > 0) || !std::isfinite(std)) fail("the noise filter has an output without a finite variance above zero");
  initial_ = covariance_root(covariance);
  if (p.has("density") != p.has("density_at")) fail("density and density_at belong together");
  if (!p.has("density")) {
    scale_ = p.number("std") / std;
    return;
  }
  if (p.given("std")) fail("std is given as well as density; allowed: one of the two");
  const double at = p.number("density_at") / rate_.hz();
  if (!(at >= 0 && at <= 0.5)) {
    fail("density_at is " + hertz(p.number("density_at")) + ", allowed: at most half of the sample rate, " +
         hertz(0.5 * rate_.hz()));
  }
  const double gain = gain_at(filter_, at);
  if (!(gain > 1e-12 * std)) fail("the noise filter has no output at density_at, " + hertz(p.number("density_at")));
  // White noise of variance 1 has a one-sided density of 2 / rate.
  scale_ = p.number("density") / (gain * std::sqrt(2 / rate_.hz()));
}

void ColouredNoise::resolve(Facts& f) { f.out(out) = source_facts(rate_, unit_, channels_); }

void ColouredNoise::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  noise_.assign(static_cast<std::size_t>(channels_), {numerics::Random(0), Eigen::VectorXd::Zero(filter_.states())});
  next_state_ = Eigen::VectorXd::Zero(filter_.states());
  reset();
}

void ColouredNoise::process(Io& io) {
  for (std::size_t c = 0; c < noise_.size(); ++c) {
    for (double& value : io.write(out, static_cast<int>(c))) value = mean_ + scale_ * next(noise_[c]);
  }
}

double ColouredNoise::next(Channel& channel) {
  const double e = channel.random.normal();
  double y = filter_.D(0, 0) * e;
  for (Eigen::Index i = 0; i < filter_.states(); ++i) {
    y += filter_.C(0, i) * channel.state[i];
    double state = filter_.B(i, 0) * e;
    for (Eigen::Index j = 0; j < filter_.states(); ++j) state += filter_.A(i, j) * channel.state[j];
    next_state_[i] = state;
  }
  channel.state.swap(next_state_);
  return y;
}

void ColouredNoise::reset() {
  for (std::size_t c = 0; c < noise_.size(); ++c) {
    noise_[c].random = numerics::Random::stream(seed_, c);
    Eigen::VectorXd white(filter_.states());
    for (double& value : white) value = noise_[c].random.normal();
    noise_[c].state = initial_.triangularView<Eigen::Lower>() * white;
  }
}

}  // namespace bodeflow::generators
