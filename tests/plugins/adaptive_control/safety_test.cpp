#include "catch.hpp"
#include "loop.hpp"

using namespace bodeflow::test;

namespace {

Run noisy(double forgetting, std::uint64_t seed) {
  Example e = example_1();
  e.bank.point.forgetting = forgetting;
  e.bank.point.p0 = 1e4;
  Conditions c;
  c.noise = 0.05;
  c.limit = 10.0;
  c.seed = seed;
  return run(e, c);
}

/// The estimators' largest relative error at sample k.
double bias(const Example& e, const Run& r, std::size_t k, std::size_t j) {
  return std::abs(r.response[k][j] / true_response(e)[j] - 1.0);
}

/// The adaptive loop over the loop with the known plant, while a unit load acts from sample 400.
double over_known_plant(Example e, double forgetting) {
  e.bank.point.forgetting = forgetting;
  Conditions c;
  c.load_at = 400;
  c.limit = 10.0;
  const Run adaptive = run(e, c);
  c.known_plant = true;
  return adaptive.rms(400, 500) / run(e, c).rms(400, 500);
}

}  // namespace

TEST_CASE("base line with nets: tracks as the known plant does") {
  const Example e = example_1();
  Conditions c;
  const Run adaptive = run(e, c);
  c.known_plant = true;
  CHECK(adaptive.rms(100, 400) < 1.1 * run(e, c).rms(100, 400));
  for (std::size_t j = 0; j < 3; ++j) CHECK(bias(e, adaptive, 30, j) < 0.015);
}

TEST_CASE("a constant command for 2000 samples: no bursts, and the next steps are followed") {
  Example e = example_1();
  e.bank.point.forgetting = 0.98;
  Conditions c;
  c.samples = 2500;
  c.noise = 0.01;
  c.limit = 10.0;
  c.command = [](int k) { return k < 2000 || (k / 50) % 2 == 1 ? 1.0 : -1.0; };
  const Run r = run(e, c);
  CHECK(r.largest_u(300, 2000) < 1.1);
  CHECK(r.rms(2100, 2500) < 0.02);
}

TEST_CASE("demands far too fast: the ladder lowers them, and the control signal stays small") {
  const Example e = example_1(1.0, 1.0);
  Conditions c;
  c.limit = 10.0;
  const Run r = run(e, c);
  CHECK(r.largest_u(80, 500) < 5.0);
  CHECK(r.rms(100, 400) < 0.2);
}

TEST_CASE("noise and forgetting 0.99: the worst of six seeds tracks within 0.09") {
  double worst = 0.0, largest = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Run r = noisy(0.99, seed);
    worst = std::max(worst, r.rms(100, 400));
    largest = std::max(largest, r.largest_u(80, 500));
  }
  CHECK(worst < 0.09);
  CHECK(largest < 3.0);
}

TEST_CASE("a unit load: within 1.1 times the known plant in examples 1 to 3, with and without forgetting") {
  for (const double forgetting : {1.0, 0.99}) {
    CHECK(over_known_plant(example_1(), forgetting) < 1.1);
    CHECK(over_known_plant(example_1_third_order(), forgetting) < 1.1);
    CHECK(over_known_plant(example_2(), forgetting) < 1.1);
    CHECK(over_known_plant(example_3(2), forgetting) < 1.1);
    CHECK(over_known_plant(example_3(3), forgetting) < 1.1);
  }
}

TEST_CASE("without nets a unit load makes example 2 diverge up to its actuator's limits") {
  Example e = example_2();
  without_nets(e);
  Conditions c;
  c.watched = false;
  c.load_at = 400;
  c.limit = 10.0;
  CHECK(run(e, c).rms(400, 500) > 2.0);
}

TEST_CASE("an actuator that just reaches the command: anti-windup keeps the overshoot below 4 %") {
  Conditions c;
  c.limit = 1.1;
  const Run r = run(example_1(), c);
  double overshoot = 0.0;
  for (std::size_t k = 120; k < 500; ++k) overshoot = std::max(overshoot, std::abs(r.y[k]) - 1.0);
  CHECK(overshoot < 0.04);
  for (std::size_t j = 0; j < 3; ++j) CHECK(bias(example_1(), r, 399, j) < 0.02);
}

TEST_CASE("a gain that doubles within 50 samples is followed") {
  Example e = example_1();
  e.clock = 20;
  e.bank.point.forgetting = 0.98;
  Conditions c;
  c.samples = 850;
  c.limit = 10.0;
  c.gain = [](int k) { return k < 200 ? 1.0 : k > 250 ? 2.0 : 1.0 + (k - 200) / 50.0; };
  CHECK(run(e, c).rms(650, 800) < 0.03);
}

TEST_CASE("example 4, an integrator with delay, adapts with small control signals and keeps a small load") {
  Conditions c;
  c.load_at = 400;
  c.load = 0.1;
  c.limit = 10.0;
  const Example e = example_4();
  const Run adaptive = run(e, c);
  c.known_plant = true;
  const Run known = run(e, c);
  CHECK(adaptive.rms(100, 400) < 1.5 * known.rms(100, 400));
  CHECK(adaptive.rms(400, 500) < 1.1 * known.rms(400, 500));
}

TEST_CASE("every net that acts tells its cause and its sample") {
  Example e = example_1(1.0, 1.0);
  e.bank.point.forgetting = 0.98;
  ac::AdaptiveController controller(*ac::EstimatorBank::make(e.bank), *ac::Designer::make(e.design), ac::RstController(-10, 10));
  SimulatedPlant plant(e.plant, 0.0);
  bodeflow::numerics::Random random(3);
  for (int k = 0; k < 1500; ++k) {
    // Steps, silence from 500 to 1000, a load from 1100.
    const double u_c = k < 500 || k > 1000 ? ((k / 30) % 2 == 0 ? 1.0 : -1.0) : 1.0;
    plant.input(controller.step(plant.output() + 0.01 * random.normal(), u_c) + (k > 1100 ? 1.0 : 0.0));
  }
  std::map<ac::Net, int> begun;
  const auto count = [&](ac::NetLog& log) {
    for (std::size_t i = 0; i < log.count(); ++i) {
      if (!log[i].begins) continue;
      ++begun[log[i].net];
      if (log[i].net == ac::Net::excitation && log[i].sample > 500) CHECK(log[i].value <= log[i].limit);
      if (log[i].net == ac::Net::huber) CHECK(log[i].value > log[i].limit);
      if (log[i].net == ac::Net::ladder) CHECK(log[i].refusal != ac::Refusal::none);
    }
    CHECK(log.lost() == 0);
  };
  count(controller.bank().log());
  count(controller.designer().log());
  CHECK(begun[ac::Net::excitation] >= 3);
  CHECK(begun[ac::Net::huber] >= 1);
  CHECK(begun[ac::Net::ladder] >= 1);
  CHECK(begun[ac::Net::rate] >= 1);
}

TEST_CASE("a limit cycle while the command rests leads to a retreat that tells its cause") {
  const Example e = example_1();
  auto designer = *ac::Designer::make(e.design);
  const auto truth = true_response(e);
  const auto retreats = [&](double u_c, int at_limit, int samples) {
    int found = 0;
    for (int k = 0; k < samples; ++k) {
      designer.watch(u_c + 0.1 * (k % 2), u_c, k % 10 == 0 ? at_limit : 0);
      designer.step(truth.data());
      for (std::size_t i = 0; i < designer.log().count(); ++i) {
        const ac::NetEvent& event = designer.log()[i];
        if (event.net != ac::Net::retreat || !event.begins) continue;
        ++found;
        CHECK(event.departure == ac::Departure::limits);
        CHECK(event.value > event.limit);
      }
      designer.log().clear();
    }
    return found;
  };
  CHECK(retreats(1.0, 1, 60) == 0);                                                               // the start controller
  CHECK(retreats(-1.0, 0, 100) == 0);                                                             // a designed one without limits
  for (int step = 0; step < 10; ++step) CHECK(retreats(step % 2 == 0 ? 1.0 : -1.0, 1, 40) == 0);  // commands that change
  CHECK(retreats(1.0, 1, 100) == 1);
}

TEST_CASE("an actuator that stays at its limit is no limit cycle") {
  ac::Watchdog watchdog;
  using InUse = ac::Watchdog::InUse;
  watchdog.step(0.0, -1.0, 0, InUse::start_controller);
  for (int k = 0; k < 2000; ++k) {
    CHECK(watchdog.step(0.5, 1.0, 1, InUse::designed).departure == ac::Departure::none);
  }
}

TEST_CASE("what swings out after a retreat does not widen the range of the watch") {
  ac::Watchdog watchdog;
  using InUse = ac::Watchdog::InUse;
  watchdog.step(0.0, -1.0, 0, InUse::start_controller);
  watchdog.step(0.0, 1.0, 0, InUse::start_controller);
  CHECK(watchdog.step(3.5, 1.0, 0, InUse::designed).departure == ac::Departure::output);
  watchdog.step(9.0, 1.0, 0, InUse::start_controller_again);
  const auto found = watchdog.step(3.5, 1.0, 0, InUse::designed);
  CHECK(found.departure == ac::Departure::output);
  CHECK(found.value == 3.5);
}

TEST_CASE("a controller that a changed plant makes unstable is given up, and demands are lowered") {
  Example e = example_1();
  e.bank.point.forgetting = 0.99;
  e.design.start_gain = 0.3;
  Conditions c;
  c.samples = 1500;
  c.limit = 1e6;
  c.gain = [](int k) {
    return k < 300 ? 1.0 : 5.0;
  };  // at once, beyond the gain margin of 3.4; that of the start controller is 9
  const Run watched = run(e, c);
  c.watched = false;
  const Run unwatched = run(e, c);
  const auto largest = [](const Run& r) {
    double y = 0.0;
    for (const double value : r.y) y = std::max(y, std::abs(value));
    return y;
  };
  INFO(largest(watched) << " and " << largest(unwatched));
  CHECK(largest(watched) < 0.1 * largest(unwatched));
  CHECK(largest(watched) < 60.0);
  CHECK(watched.rms(1200, 1500) < 0.3);  // with demands that are two steps lower
}
