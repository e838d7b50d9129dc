#include "experiments.hpp"

#include <Eigen/Core>
#include <cmath>

#include "bodeflow/numerics/fft.hpp"
#include "catch.hpp"
#include "orthogonal.hpp"
#include "plugins/loaded_block.hpp"

using namespace bodeflow::generators;
using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

constexpr std::int64_t kPeriod = 90;
constexpr std::int64_t kLast = 40;

LoadedBlock& given(LoadedBlock& block, std::int64_t inputs, const char* phases = "random") {
  return block.set("sample_rate", 1e3)
      .set("period", kPeriod)
      .set("lines.first", std::int64_t{1})
      .set("lines.last", kLast)
      .set("phases", phases)
      .set("inputs", inputs)
      .set("experiment_periods", std::int64_t{3})
      .set("seed", std::int64_t{4});
}

// Spectra of one period: lines x channels.
Eigen::MatrixXcd spectra(const Channels& y, std::int64_t period) {
  Eigen::MatrixXcd result(kPeriod / 2 + 1, static_cast<Eigen::Index>(y.size()));
  for (std::size_t j = 0; j < y.size(); ++j) {
    const Eigen::Map<const Eigen::VectorXd> samples(y[j].data() + period * kPeriod, kPeriod);
    result.col(static_cast<Eigen::Index>(j)) = bodeflow::numerics::half_dft(samples) * (2.0 / kPeriod);
  }
  return result;
}

}  // namespace

TEST_CASE("the matrices of the experiments are orthogonal with entries of modulus one, for any number of inputs") {
  for (std::size_t n = 1; n <= 17; ++n) {
    Eigen::MatrixXcd w(n, n);
    for (std::size_t e = 0; e < n; ++e) {
      for (std::size_t j = 0; j < n; ++j)
        w(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(j)) = orthogonal_entry(e, j, n);
    }
    const auto size = static_cast<Eigen::Index>(n);
    CHECK((w * w.adjoint() - static_cast<double>(n) * Eigen::MatrixXcd::Identity(size, size)).cwiseAbs().maxCoeff() < 1e-14 * 17);
    CHECK((w.cwiseAbs().array() - 1).abs().maxCoeff() < 1e-15);
  }
}

TEST_CASE("at every line the spectra of n experiments are orthogonal to rounding, and of the same size") {
  const std::int64_t inputs = GENERATE(as<std::int64_t>{}, 2, 3, 4);
  LoadedBlock block("generators.multisine");
  given(block, inputs).start();
  CHECK(block.resolve()[0].channels == inputs);
  CHECK(block.resolve()[0].length == 3 * inputs * kPeriod);
  const Channels y = block.run(10000, 64);
  REQUIRE(y[0].size() == static_cast<std::size_t>(3 * inputs * kPeriod));
  std::vector<Eigen::MatrixXcd> experiments;
  for (std::int64_t e = 0; e < inputs; ++e) experiments.push_back(spectra(y, 3 * e));
  for (Eigen::Index k = 1; k <= kLast; ++k) {
    Eigen::MatrixXcd u(inputs, inputs);  // inputs x experiments
    for (Eigen::Index e = 0; e < inputs; ++e) u.col(e) = experiments[static_cast<std::size_t>(e)].row(k).transpose();
    const Eigen::MatrixXcd expected = static_cast<double>(inputs) * Eigen::MatrixXcd::Identity(inputs, inputs);
    REQUIRE((u * u.adjoint() - expected).cwiseAbs().maxCoeff() < 1e-13);
  }
  // The channels have phases of their own.
  CHECK(std::abs(experiments[0](5, 0) - experiments[0](5, 1)) > 1e-3);
}

TEST_CASE("an experiment lasts experiment_periods equal periods, and a realisation has phases of its own") {
  LoadedBlock block("generators.multisine");
  given(block, 2).set("realisations", std::int64_t{3}).start();
  CHECK(block.resolve()[0].length == 3 * 2 * 3 * kPeriod);
  const Channels y = block.run(10000, 1000);
  for (std::int64_t period = 0; period < 18; ++period) {
    const std::int64_t first = period / 3 * 3;
    REQUIRE(spectra(y, period) == spectra(y, first));
    if (first > 0) CHECK((spectra(y, first) - spectra(y, first - 3)).cwiseAbs().maxCoeff() > 0.1);
  }
}

TEST_CASE("realisations with one input draw new phases with the same amplitudes") {
  LoadedBlock block("generators.multisine");
  given(block, 1).set("realisations", std::int64_t{4}).start();
  const Channels y = block.run(10000, 333);
  REQUIRE(y[0].size() == 4 * 3 * kPeriod);
  for (std::int64_t m = 1; m < 4; ++m) {
    CHECK((spectra(y, 3 * m).cwiseAbs() - spectra(y, 0).cwiseAbs()).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((spectra(y, 3 * m) - spectra(y, 0)).cwiseAbs().maxCoeff() > 0.5);
  }
}

TEST_CASE("rms and peak scale each channel, over all experiments") {
  for (const std::int64_t inputs : {2, 3}) {
    std::vector<double> levels = {0.5, 2.0, 3.0};
    levels.resize(static_cast<std::size_t>(inputs));
    LoadedBlock by_rms("generators.multisine"), by_peak("generators.multisine");
    given(by_rms, inputs).set("rms", levels).start();
    given(by_peak, inputs).set("peak", levels).set("realisations", std::int64_t{2}).start();
    const Channels r = by_rms.run(10000), p = by_peak.run(10000);
    for (std::size_t j = 0; j < levels.size(); ++j) {
      double energy = 0, peak = 0;
      for (const double value : r[j]) energy += value * value;
      for (const double value : p[j]) peak = std::max(peak, std::abs(value));
      CHECK(std::sqrt(energy / static_cast<double>(r[j].size())) == Approx(levels[j]).epsilon(1e-12));
      CHECK(peak == Approx(levels[j]).epsilon(1e-12));
    }
  }
}

TEST_CASE("optimised phases of several inputs differ from channel to channel and stay below the crest factor of random ones") {
  Design design;
  design.period = 512;
  for (std::int64_t k = 1; k <= 60; ++k) design.lines.push_back({k, 1.0, 0.0});
  design.inputs = 2;
  design.phases = Phases::random;
  const double random = Experiments(design, 1).crest_factor();
  design.phases = Phases::optimised;
  const Experiments optimised(design, 1);
  CHECK(optimised.crest_factor() < 1.45);
  CHECK(random > 2.2);
  std::vector<double> a(512), b(512);
  optimised.copy(0, 0, 0, 0, a);
  optimised.copy(0, 0, 1, 0, b);
  CHECK(a != b);
}

TEST_CASE("experiments that contradict themselves are refused") {
  const auto refused = [](auto&& set) {
    LoadedBlock block("generators.multisine");
    block.set("sample_rate", 1e3).set("period", kPeriod).set("lines.list", std::vector<std::int64_t>{1, 3, 5});
    set(block);
    return refusal_of([&] { block.configure(); });
  };
  using Numbers = std::vector<double>;
  const std::int64_t two = 2;
  CHECK(refused([&](auto& b) { b.set("inputs", two); }) ==
        "inputs and realisations need experiment_periods, the number of periods of each experiment");
  CHECK(refused([&](auto& b) { b.set("periods", two).set("experiment_periods", two); }) ==
        "periods is given as well as experiment_periods; the stream ends after realisations x inputs x experiment_periods");
  CHECK(refused([&](auto& b) { b.set("realisations", two).set("experiment_periods", two); }) ==
        "phases are schroeder, the same in all realisations; allowed: random, optimised");
  CHECK(refused([&](auto& b) { b.set("rms", Numbers{1}).set("peak", Numbers{1}); }) ==
        "rms is given as well as peak; allowed: one of the two");
  CHECK(refused([&](auto& b) {
          b.set("rms", Numbers{1, 2});
        }) == "rms has 2 values, allowed: 1, or one for each of the 1 inputs");
  CHECK(refused([&](auto& b) { b.set("peak", Numbers{0}); }) == "peak is not above zero");
  CHECK(refused([&](auto& b) { b.set("amplitude", Numbers{0}); }) == "all amplitudes are zero");
  CHECK(refused([&](auto& b) { b.set("amplitude", Numbers{1}).set("spectrum.frequencies", Numbers{1}); }) ==
        "amplitude is given as well as spectrum; allowed: one of the two");
  CHECK(refused([&](auto& b) { b.set("spectrum.frequencies", Numbers{1}); }) == "spectrum needs frequencies and amplitudes");
  CHECK(refused([&](auto& b) { b.set("detection.seed", two); }) == "detection.seed is given without detection.group");
  CHECK(refused([&](auto& b) { b.set("period", std::int64_t{1000003}); }) ==
        "a period of 1000003 samples has large prime factors and takes too long to prepare; near it: 1000000 or 1012500");
  CHECK(refused([&](auto& b) { b.set("period", std::int64_t{1} << 28); }) ==
        "1 signals of 268435456 samples take too much time or memory to prepare; shorten the period or run the realisations one "
        "by one");
  CHECK(refused([&](auto& b) { b.set("periods", std::int64_t{1000000000000}).set("period", std::int64_t{10000000}); }) ==
        "1000000000000 periods have more samples than can be counted");
}

TEST_CASE("a multisine tells its period, lines, amplitudes and crest factor") {
  LoadedBlock block("generators.multisine");
  block.set("sample_rate", 1e3).set("period", std::int64_t{100}).set("lines.list", std::vector<std::int64_t>{2, 5});
  block.set("amplitude", std::vector<double>{3, 4}).set("rms", std::vector<double>{std::sqrt(0.5)}).set("phases", "zero");
  block.configure();
  const auto notes = block.resolve()[0].notes;
  CHECK(notes.at("excitation.period") == std::vector<double>{0.1});
  CHECK(notes.at("excitation.frequencies") == std::vector<double>{20, 50});
  CHECK(notes.at("excitation.amplitudes")[0] == Approx(0.6));
  CHECK(notes.at("excitation.amplitudes")[1] == Approx(0.8));
  CHECK(notes.at("excitation.crest_factor")[0] == Approx(1.4 * std::sqrt(2.0)));
  CHECK(notes.count("excitation.experiment") == 0);
}

TEST_CASE("a multisine tells after which time its phases change") {
  LoadedBlock block("generators.multisine");
  block.set("sample_rate", 1e3).set("period", std::int64_t{100}).set("lines.list", std::vector<std::int64_t>{2, 5});
  block.set("experiment_periods", std::int64_t{3}).set("realisations", std::int64_t{4}).set("phases", "random");
  block.configure();
  const auto notes = block.resolve()[0].notes;
  REQUIRE(notes.count("excitation.experiment") == 1);
  CHECK(notes.at("excitation.experiment")[0] == Approx(0.3));
}

TEST_CASE("what depends on the run's seed is not told before the run") {
  LoadedBlock block("generators.multisine");
  block.set("sample_rate", 1e3).set("period", std::int64_t{100}).set("lines.list", std::vector<std::int64_t>{2, 5});
  block.set("phases", "random").configure();
  const auto notes = block.resolve()[0].notes;
  CHECK(notes.count("excitation.crest_factor") == 0);
  CHECK(notes.at("excitation.amplitudes") == std::vector<double>{1, 1});
}

TEST_CASE("an odd multisine with detection lines is empty at even lines and at one line of each group") {
  LoadedBlock block("generators.multisine");
  block.set("sample_rate", 1e3).set("period", std::int64_t{512}).set("lines.first", std::int64_t{1});
  block.set("lines.last", std::int64_t{200}).set("lines.parity", "odd").set("detection.group", std::int64_t{4}).start();
  const std::vector<double> y = block.run(512)[0];
  const Eigen::VectorXd found =
      bodeflow::numerics::half_dft(Eigen::Map<const Eigen::VectorXd>(y.data(), 512)).cwiseAbs() * (2.0 / 512);
  for (Eigen::Index k = 0; k < 256; k += 2) REQUIRE(found[k] < 1e-14);
  for (Eigen::Index begin = 1; begin < 200; begin += 8) {
    int empty = 0;
    for (Eigen::Index k = begin; k < begin + 8; k += 2) {
      empty += found[k] < 1e-14 ? 1 : 0;
      CHECK((found[k] < 1e-14 || std::abs(found[k] - 1) < 1e-13));
    }
    CHECK(empty == 1);
  }
}
