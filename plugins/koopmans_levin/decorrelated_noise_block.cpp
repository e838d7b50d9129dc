#include "decorrelated_noise_block.hpp"

#include <algorithm>
#include <cmath>

#include "decorrelated_noise.hpp"

namespace bodeflow::koopmans_levin {

void DecorrelatedNoise::describe(Describe& d) {
  d.id("koopmans_levin.decorrelated_noise")
      .summary("Adds noise of exact mean, variance and zero correlation over a record to an input and an output.")
      .cost_ns(60);
  d.doc(
      "For test benches: each stretch of `samples` gets normal noise whose mean is zero, whose mean square is the variance, and "
      "which is orthogonal to both signals and to the noise of the other. Published studies that clean their noise so show less "
      "spread than white noise has; generators.noise is what a sensor does.");
  d.stream_in(input).doc("clean, one channel");
  d.stream_in(output).doc("clean, one channel");
  d.stream_out(noisy_input).same_as(input);
  d.stream_out(noisy_output).same_as(output);
  d.required<std::int64_t>("samples").range(8, 10'000'000).doc("length of the record");
  d.required<double>("input_variance").unit("").range(0, 1e300).doc("of the noise on the input");
  d.required<double>("output_variance").unit("").range(0, 1e300).doc("of the noise on the output");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the noise; without it the run's seed and the block's name do");
}

void DecorrelatedNoise::configure(const Parameters& p) {
  samples_ = p.integer("samples");
  input_variance_ = p.number("input_variance");
  output_variance_ = p.number("output_variance");
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
}

void DecorrelatedNoise::resolve(Facts& f) {
  for (const auto& port : {input, output}) {
    f.samples(port, samples_);
    if (f.in(port).known && f.in(port).channels != 1)
      fail(std::string("'") + port.name + "' has " + std::to_string(f.in(port).channels) + " channels; allowed: one");
  }
  for (const auto& port : {noisy_input, noisy_output}) f.samples(port, samples_);
  f.out(noisy_input).notes["noise.std"] = {std::sqrt(input_variance_)};
  f.out(noisy_output).notes["noise.std"] = {std::sqrt(output_variance_)};
}

void DecorrelatedNoise::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  reset();
}

void DecorrelatedNoise::process(Io& io) {
  const auto u = io.read(input, 0), y = io.read(output, 0);
  const auto noisy_u = io.write(noisy_input, 0), noisy_y = io.write(noisy_output, 0);
  const auto length = static_cast<Eigen::Index>(samples_);
  const auto step = static_cast<std::size_t>(samples_);
  for (std::size_t from = 0; from < u.size(); from += step) {
    const Eigen::Map<const Eigen::VectorXd> clean_u(u.data() + from, length), clean_y(y.data() + from, length);
    const auto noise = decorrelated_noise(clean_u, clean_y, input_variance_, output_variance_, random_);
    if (!noise) fail(noise.error().text);
    Eigen::Map<Eigen::VectorXd>(noisy_u.data() + from, length) = clean_u + noise->input;
    Eigen::Map<Eigen::VectorXd>(noisy_y.data() + from, length) = clean_y + noise->output;
  }
}

void DecorrelatedNoise::reset() { random_ = numerics::Random(seed_); }

}  // namespace bodeflow::koopmans_levin
