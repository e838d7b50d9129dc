#include <bodeflow/numerics/iir_design.hpp>
#include <bodeflow/numerics/narrow_band_pass.hpp>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "notch_section.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Matrix;
using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;
using bodeflow::test::Stream;
namespace numerics = bodeflow::numerics;

namespace {

using List = std::vector<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kRate = 1000;

List impulse(std::size_t count) {
  List x(count);
  x[0] = 1;
  return x;
}

List tone(double f_hz, std::size_t count) {
  List x(count);
  for (std::size_t n = 0; n < count; ++n) x[n] = std::sin(2 * kPi * std::fmod(f_hz / kRate * static_cast<double>(n), 1.0));
  return x;
}

double peak(const List& y, std::size_t from) {
  double most = 0;
  for (std::size_t n = from; n < y.size(); ++n) most = std::max(most, std::abs(y[n]));
  return most;
}

List responses(const numerics::Sections& sections, std::size_t count) {
  const Eigen::VectorXd h = numerics::impulse_response(sections, static_cast<Eigen::Index>(count));
  return {h.begin(), h.end()};
}

Channels run(LoadedBlock& block, List x) {
  const std::size_t count = x.size();
  return block.feed({Stream::of(std::move(x))}).start().run(count);
}

// What a block says of an input of 1000 samples/s.
template <class Set>
std::string refusal(const std::string& id, Set&& set) {
  LoadedBlock block(id);
  set(block);
  block.feed({Stream::of(List(8))});
  return refusal_of([&] { block.start(); });
}

}  // namespace

TEST_CASE("filters.iir has the impulse response of its design, edges in Hz") {
  LoadedBlock block("filters.iir");
  block.set("family", "elliptic").set("pass", "band_pass").set("order", std::int64_t{3}).set("edges", List{100, 200});
  block.set("ripple", 0.2).set("attenuation", 45.0);
  const double h = 2 * kPi / kRate;
  const auto filter =
      numerics::design_iir({numerics::FilterKind::elliptic, numerics::Pass::band, 3, {100 * h, 200 * h}, 0.2, 45});
  CHECK(run(block, impulse(200))[0] == responses(filter->sections, 200));
}

TEST_CASE("filters.iir filters by impulse invariance") {
  LoadedBlock block("filters.iir");
  block.set("method", "impulse_invariance").set("order", std::int64_t{2}).set("edges", List{20});
  const List h = run(block, impulse(100))[0];
  // A Butterworth filter of order 2: sqrt(2) w exp(-w t / sqrt 2) sin(w t / sqrt 2), w = 2 pi 20.
  for (std::size_t n = 0; n < 100; ++n) {
    const double x = 2 * kPi * 20 * static_cast<double>(n) / kRate / std::sqrt(2);
    CHECK(h[n] == Approx(2 * kPi * 20 * std::sqrt(2) / kRate * std::exp(-x) * std::sin(x)).margin(1e-14));
  }
}

TEST_CASE("filters.iir_bank gives every channel every band, named after both") {
  LoadedBlock block("filters.iir_bank");
  block.set("bands", Matrix{3, 2, {0, 50, 50, 200, 200, 500}}).set("order", std::int64_t{2});
  Stream input = Stream::with({impulse(64), List(64)});
  input.facts.channel_names = {"u", "y"};
  const Channels y = block.feed({input}).start().run(64);
  REQUIRE(y.size() == 6);
  const double h = 2 * kPi / kRate;
  using enum numerics::Pass;
  const auto butterworth = numerics::FilterKind::butterworth;
  CHECK(y[0] == responses(numerics::design_iir({butterworth, low, 2, {50 * h}})->sections, 64));
  CHECK(y[1] == responses(numerics::design_iir({butterworth, band, 2, {50 * h, 200 * h}})->sections, 64));
  CHECK(y[2] == responses(numerics::design_iir({butterworth, high, 2, {200 * h}})->sections, 64));
  CHECK(y[3] == List(64));
}

TEST_CASE("filters.narrow_band_pass has the impulse responses of the reference at its frequencies") {
  LoadedBlock block("filters.narrow_band_pass");
  block.set("frequencies", List{0.3 * kRate / (2 * kPi), 1.0 * kRate / (2 * kPi)});
  const Channels y = run(block, impulse(120));
  REQUIRE(y.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    auto filter = *numerics::NarrowBandPass::design(0.9, 2, kPi / 90, i == 0 ? 0.3 : 1.0);
    for (std::size_t n = 0; n < 120; ++n) CHECK(std::abs(y[i][n] - filter.step(n == 0 ? 1.0 : 0.0)) < 1e-13);
  }
}

TEST_CASE("narrow_low keeps the peak of a low filter at its centre") {
  LoadedBlock block("filters.narrow_band_pass");
  block.set("frequencies", List{0.05 * kRate / (2 * kPi)}).set("narrow_low", true).set("spacing", 0.005);
  const List h = run(block, impulse(4000))[0];
  double best = 0, at = 0;
  for (double w = 0.02; w < 0.15; w += 0.0005) {
    std::complex<double> sum = 0;
    for (std::size_t n = 0; n < h.size(); ++n) sum += std::polar(h[n], -w * static_cast<double>(n));
    if (std::abs(sum) > best) best = std::abs(sum), at = w;
  }
  CHECK(at == Approx(0.05).epsilon(0.25));
}

TEST_CASE("filters.notch removes its frequencies and leaves others") {
  LoadedBlock mains("filters.notch"), other("filters.notch");
  for (LoadedBlock* block : {&mains, &other}) block->set("frequencies", List{50, 150}).set("width", List{5});
  List hum = tone(50, 3000), third = tone(150, 3000);
  for (std::size_t n = 0; n < hum.size(); ++n) hum[n] += third[n] + 2;
  const List left = run(mains, hum)[0];
  for (std::size_t n = 2500; n < 3000; ++n) CHECK(left[n] == Approx(2).epsilon(1e-9));
  CHECK(peak(run(other, tone(97, 3000))[0], 2500) == Approx(1).epsilon(0.01));
}

TEST_CASE("a notch is 3 dB down over its width, 0 at its frequency and 1 at both ends") {
  const double w = 0.7, width = 0.2;
  const numerics::Sections notch{*bodeflow::filters::notch_section(w, width)};
  const auto gain = [&](double w_h) { return std::abs(numerics::response(notch, w_h)); };
  // |H|^2 = 1/2 where cos(w_h -+ width / 2) = cos(w) cos(width / 2).
  const double middle = std::acos(std::cos(w) * std::cos(width / 2));
  CHECK(gain(middle - width / 2) == Approx(std::sqrt(0.5)).epsilon(1e-12));
  CHECK(gain(middle + width / 2) == Approx(std::sqrt(0.5)).epsilon(1e-12));
  CHECK(gain(w) < 1e-14);
  CHECK(gain(0) == Approx(1).epsilon(1e-14));
  CHECK(gain(kPi) == Approx(1).epsilon(1e-14));
  CHECK(bodeflow::filters::notch_section(0, 0.1).error().text == "a notch must lie between 0 and pi rad (the Nyquist frequency)");
}

TEST_CASE("steps, ramps and sinusoids leave only a transient behind a disturbance filter") {
  const auto disturbed = [](std::int64_t steps, List x) {
    LoadedBlock block("filters.disturbance");
    block.set("steps", steps).set("low", 5.0).set("high", 100.0).set("sinusoids", List{50}).set("width", 10.0);
    return peak(run(block, std::move(x))[0], 2500);
  };
  List ramp(3000), step(3000, 7.0);
  for (std::size_t n = 0; n < ramp.size(); ++n) ramp[n] = 0.5 * static_cast<double>(n);
  CHECK(disturbed(1, step) < 1e-12);
  CHECK(disturbed(1, ramp) > 1);
  CHECK(disturbed(2, ramp) < 1e-9);
  CHECK(disturbed(1, tone(50, 3000)) < 1e-12);
  CHECK(disturbed(1, tone(25, 3000)) == Approx(1).epsilon(0.1));
}

TEST_CASE("filters.biquads takes rows as they are, in series or side by side") {
  const Matrix rows{2, 6, {1, 2, 1, 2, -1, 0.4, 0.5, 0, 0, 1, 0.2, 0}};
  const numerics::Sections sections{{0.5, 1, 0.5, -0.5, 0.2}, {0.5, 0, 0, 0.2, 0}};
  LoadedBlock series("filters.biquads"), bank("filters.biquads");
  CHECK(run(series.set("coefficients", rows), impulse(50))[0] == responses(sections, 50));
  const Channels y = run(bank.set("coefficients", rows).set("arrangement", "bank"), impulse(50));
  REQUIRE(y.size() == 2);
  CHECK(y[0] == responses({sections[0]}, 50));
  CHECK(y[1] == responses({sections[1]}, 50));
}

TEST_CASE("notes of an excitation pass a filter, its amplitudes do not") {
  Stream input = Stream::of(List(8));
  input.facts.notes = {{"excitation.period", {0.1}}, {"excitation.amplitudes", {1, 2}}, {"plant.settling_time", {0.001}}};
  LoadedBlock block("filters.iir");
  block.set("edges", List{1}).feed({input}).configure();
  const auto facts = block.resolve()[0];
  CHECK(facts.note("excitation.period") == List{0.1});
  CHECK(facts.note("excitation.amplitudes").empty());
  // Butterworth, order 4, 1 Hz: the slowest poles at 2 pi cos(67.5 degrees).
  CHECK(facts.note("plant.settling_time")[0] == Approx(5 / (2 * kPi * std::cos(0.375 * kPi))).epsilon(1e-4));
}

TEST_CASE("a value that is not finite ends the run of a recursive filter by name") {
  LoadedBlock block("filters.iir");
  List x(128, 1.0);
  x[70] = std::nan("");
  CHECK(refusal_of([&] { run(block.set("edges", List{100}), x); }) ==
        "channel 1 of 'in': the filter's state is not finite before sample 128; allowed are finite samples");
}

TEST_CASE("filters refuse frequencies, orders and coefficients that cannot be, by name") {
  const auto iir = [](List edges, const char* pass) {
    return refusal("filters.iir", [&](LoadedBlock& b) { b.set("edges", edges).set("pass", pass); });
  };
  CHECK(iir({600}, "low_pass") == "edges: 600 Hz; allowed: above 0 and below the Nyquist frequency 500 Hz of 'in'");
  CHECK(iir({100}, "band_pass") == "edges has 1 frequencies, a band_pass filter has 2");
  CHECK(iir({200, 100}, "band_stop") == "edges: the lower edge of the band must lie below the upper one");
  const auto narrow = [](double f, std::int64_t m) {
    return refusal("filters.narrow_band_pass", [&](LoadedBlock& b) { b.set("frequencies", List{50, f}).set("sections", m); });
  };
  CHECK(narrow(700, 2) == "frequencies: 700 Hz; allowed: above 0 and below the Nyquist frequency 500 Hz of 'in'");
  CHECK(narrow(2, 2) ==
        "frequencies: 2 Hz at 1000 samples/s: the centre w h = 0.0125664 rad is too near zero: a filter with m = 2 and dphi = "
        "0.0349066 rad needs more than dphi (m - 1) / 2, at least 0.0175533 rad");
  const auto bank = [](std::vector<double> bands) {
    return refusal("filters.iir_bank", [&](LoadedBlock& b) { b.set("bands", Matrix{bands.size() / 2, 2, bands}); });
  };
  CHECK(bank({100, 50}) == "row 1 of bands: 100 to 50 Hz; allowed: a rising band");
  CHECK(bank({10, 20, 0, 500}) == "row 2 of bands is all that there is, 0 to the Nyquist frequency: it needs no filter");
  CHECK(bank({10, 501}) == "row 1 of bands: 501 Hz; allowed: above 0 and below the Nyquist frequency 500 Hz of 'in'");
  const auto biquads = [](std::vector<double> rows) {
    return refusal("filters.biquads", [&](LoadedBlock& b) { b.set("coefficients", Matrix{1, rows.size(), rows}); });
  };
  CHECK(biquads({1, 0, 0, 1, 0, 1}) == "row 1 of coefficients: its poles lie on or outside the unit circle");
  CHECK(biquads({1, 0, 0, 0, 0, 0}) == "row 1 of coefficients: a0 is 0, allowed: any other value");
  CHECK(biquads({1, 0, 0}) == "coefficients needs rows of six: b0, b1, b2, a0, a1, a2");
  CHECK(refusal("filters.notch", [](LoadedBlock& b) {
          b.set("frequencies", List{50}).set("width", List{1, 2});
        }) == "width has 2 values for 1 frequencies; allowed: one, or one a frequency");
  CHECK(refusal("filters.disturbance", [](LoadedBlock& b) { b.set("high", 100.0); }) ==
        "steps needs low, the lower edge of the pass band");
  CHECK(refusal("filters.disturbance", [](LoadedBlock& b) { b.set("high", 100.0).set("low", 200.0); }) ==
        "filter: low must lie below high");
}
