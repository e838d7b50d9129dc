#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>

#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Matrix;
using bodeflow::Rate;
using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;
using bodeflow::test::Stream;
using List = std::vector<double>;
using Roots = std::vector<std::complex<double>>;

namespace {

const Rate kRate{100, 1};  // samples of 10 ms

LoadedBlock& transfer_function(LoadedBlock& block, const List& numerator, const List& denominator) {
  return block.set("numerator", numerator).set("denominator", denominator);
}

Stream steps(std::size_t count) { return Stream::of(List(count, 1.0), kRate); }

// The input that the block asks for beyond the first samples' past.
List wave(std::size_t count) {
  List u(count);
  for (std::size_t n = 0; n < count; ++n) u[n] = std::fmod(0.6180339887498949 * static_cast<double>(n + 1), 1.0) - 0.4;
  return u;
}

double largest_difference(const List& a, const List& b) {
  double largest = 0;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) largest = std::max(largest, std::abs(a[n] - b[n]));
  return largest;
}

}  // namespace

TEST_CASE("the step response of a first-order lag is exact at the samples") {
  LoadedBlock block("plants.linear");
  transfer_function(block, {2}, {0.05, 1}).set("unit", "rad").feed({steps(200)}).start();
  CHECK(block.resolve()[0].unit == "rad");
  CHECK(block.resolve()[0].rate == kRate);
  CHECK(block.input_flows()[0].delay == 1);
  const List y = block.run(200)[0];
  for (std::size_t n = 0; n < 200; ++n) CHECK(std::abs(y[n] + 2 * std::expm1(-0.2 * static_cast<double>(n))) < 1e-14);
}

TEST_CASE("the step response of a double integrator is the parabola of its samples") {
  LoadedBlock block("plants.linear");
  transfer_function(block, {1}, {1, 0, 0}).feed({Stream::of(List(1000, 1.0), {128, 1})}).start();
  const List y = block.run(1000)[0];
  for (std::size_t n = 0; n < 1000; ++n) REQUIRE(y[n] == static_cast<double>(n * n) / (2.0 * 128 * 128));
}

TEST_CASE("a delay of 2.37 samples shifts the step response by as much") {
  LoadedBlock block("plants.linear");
  transfer_function(block, {1}, {0.02, 1}).set("delay", 0.0237).feed({steps(50)}).start();
  CHECK(block.input_flows()[0].delay == 3);
  const List y = block.run(50)[0];
  for (std::size_t n = 0; n < 50; ++n) {
    const double t = 0.01 * static_cast<double>(n) - 0.0237;
    CHECK(std::abs(y[n] - (t > 0 ? -std::expm1(-t / 0.02) : 0.0)) < 1e-14);
  }
}

TEST_CASE("a plant with feed-through answers in the same sample") {
  LoadedBlock block("plants.linear");
  transfer_function(block, {3, 1}, {1, 1}).feed({steps(10)}).start();
  CHECK(block.input_flows()[0].delay == 0);
  const List y = block.run(10, 3, true)[0];
  for (std::size_t n = 0; n < 10; ++n) CHECK(std::abs(y[n] - (1 + 2 * std::exp(-0.01 * static_cast<double>(n)))) < 1e-14);
}

TEST_CASE("poles and zeros give the same output as their polynomials") {
  LoadedBlock factors("plants.linear"), polynomials("plants.linear");
  factors.set("zeros", Roots{-4.0}).set("poles", Roots{{-1, 30}, {-1, -30}, -5.0}).set("gain", 1802.0);
  transfer_function(polynomials, {1802, 7208}, {1, 7, 911, 4505});
  const List y = factors.feed({Stream::of(wave(500), kRate)}).start().run(500)[0];
  CHECK(largest_difference(y, polynomials.feed({Stream::of(wave(500), kRate)}).start().run(500)[0]) < 1e-12);
  CHECK(*std::max_element(y.begin(), y.end()) > 0.1);
}

TEST_CASE("a system with two inputs and three outputs is the sum of its paths, from its initial state") {
  LoadedBlock block("plants.linear");
  block.set("a", Matrix{2, 2, {-1, 0, 0, -2}}).set("b", Matrix{2, 2, {1, 0, 0, 4}}).set("c", Matrix{3, 2, {1, 0, 0, 1, 1, 1}});
  block.set("initial_state", List{0.5, -1}).set("output_names", std::vector<std::string>{"x1", "x2", "sum"});
  block.feed({Stream::with({List(100, 1.0), List(100, 0.5)}, kRate)}).start();
  CHECK(block.resolve()[0].channel_names == std::vector<std::string>{"x1", "x2", "sum"});
  const Channels y = block.run(100);
  for (std::size_t n = 0; n < 100; ++n) {
    const double t = 0.01 * static_cast<double>(n);
    const double x1 = 1 - 0.5 * std::exp(-t);
    const double x2 = 1 - 2 * std::exp(-2 * t);
    CHECK(std::abs(y[0][n] - x1) < 1e-14);
    CHECK(std::abs(y[1][n] - x2) < 1e-14);
    CHECK(std::abs(y[2][n] - x1 - x2) < 2e-14);
  }
}

TEST_CASE("a discrete-time model runs its difference equation") {
  LoadedBlock block("plants.linear");
  // y[n] = 0.5 y[n-1] + u[n-1]
  transfer_function(block, {1}, {1, -0.5}).set("domain", "discrete").set("delay", 0.02).feed({steps(20)}).start();
  CHECK(block.input_flows()[0].delay == 3);
  const List y = block.run(20)[0];
  double expected = 0;
  for (std::size_t n = 0; n < 20; ++n) {
    CHECK(y[n] == expected);
    expected = 0.5 * expected + (n >= 2 ? 1.0 : 0.0);
  }
}

TEST_CASE("the chunks of a plant's input do not show in its bits, for every number of states, and reset begins anew") {
  for (const std::size_t order : {1u, 2u, 3u, 4u, 5u, 9u}) {
    Roots poles;
    for (std::size_t k = 0; k < order; ++k) poles.push_back(-3.0 * static_cast<double>(k + 1));
    for (const double delay : {0.0, 0.013}) {
      LoadedBlock whole("plants.linear"), cut("plants.linear");
      whole.set("poles", poles).set("gain", 50.0).set("delay", delay).feed({Stream::of(wave(600), kRate)}).start();
      cut.set("poles", poles).set("gain", 50.0).set("delay", delay).feed({Stream::of(wave(600), kRate)}).start();
      const Channels y = whole.run(600, 600);
      CHECK(cut.run(600, 7) == y);
      cut.reset();
      CHECK(cut.run(600, 1, true) == y);
    }
  }
}

TEST_CASE("a plant states its delay before its input is known, so that a loop can be planned") {
  LoadedBlock block("plants.linear");
  transfer_function(block, {1}, {1, 1}).feed({Stream()}).configure();
  CHECK_FALSE(block.resolve()[0].known);
  CHECK(block.input_flows()[0].delay == 1);
}

TEST_CASE("models that cannot be meant are refused with the reason") {
  const auto refused = [](auto&& set) {
    LoadedBlock block("plants.linear");
    set(block);
    return refusal_of([&] { block.feed({steps(1)}).start(); });
  };
  const std::string forms = ", allowed: one of numerator and denominator; zeros, poles and gain; a, b, c and d";
  CHECK(refused([](LoadedBlock&) {}) == "the model is given in no form" + forms);
  CHECK(refused([](LoadedBlock& b) {
          transfer_function(b, {1}, {1, 1}).set("gain", 2.0);
        }) == "the model is given in more than one form" + forms);
  CHECK(refused([](LoadedBlock& b) { b.set("numerator", List{1}); }) == "numerator and denominator are needed together");
  CHECK(refused([](LoadedBlock& b) {
          transfer_function(b, {1, 0, 0}, {1, 1});
        }) == "the system is improper: degree 2 above degree 1");
  CHECK(refused([](LoadedBlock& b) {
          b.set("poles", Roots{{-1, 2}});
        }) == "poles: the root -1+2i stands without its conjugate -1-2i");
  CHECK(refused([](LoadedBlock& b) {
          b.set("a", Matrix{1, 1, {1}}).set("b", Matrix{1, 2, {1, 2}}).set("c", Matrix{1, 1, {1}});
        }) == "the model has 2 inputs, the stream at 'in' has 1 channel");
  CHECK(refused([](LoadedBlock& b) {
          transfer_function(b, {1}, {1, 1}).set("initial_state", List{1});
        }) == "initial_state goes with a model given by a, b, c and d");
  CHECK(refused([](LoadedBlock& b) {
          b.set("a", Matrix{1, 1, {1}}).set("b", Matrix{1, 1, {1}}).set("c", Matrix{1, 1, {1}}).set("initial_state", List{1, 2});
        }) == "initial_state has 2 values, allowed: 1, one a state");
  CHECK(refused([](LoadedBlock& b) {
          transfer_function(b, {1}, {1, 1}).set("output_names", std::vector<std::string>{"x", "y"});
        }) == "output_names has 2 entries, allowed: one for each of the 1 outputs");
  CHECK(refused([](LoadedBlock& b) {
          transfer_function(b, {1}, {1, -1e6});
        }) == "the system grows beyond the range of a double within one sample");
}
