#include <Eigen/Dense>

#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/order_scan.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Example2;
using bodeflow::test::Records;

TEST_CASE("koopmans_levin: the order rule finds order 2 of Example 1 in at least 95 of 100 records") {
  const Example1 system;
  Random random(91);
  for (const Eigen::Index samples : {500, 2000}) {
    int right = 0;
    for (int run = 0; run < 100; ++run) {
      const Records r = bodeflow::test::noisy(system.clean(random, samples), random, system.input_noise, system.ratio);
      const auto scan = scan_orders(*lines_of(r.input, r.output), system.ratio, 6);
      REQUIRE(scan);
      right += scan->chosen == 2 ? 1 : 0;
    }
    CAPTURE(samples);
    CHECK(right >= 95);
  }
}

TEST_CASE("koopmans_levin: the order rule finds order 2 in a scan that goes far beyond it") {
  const Example1 system;
  Random random(82);
  int right = 0;
  for (int run = 0; run < 50; ++run) {
    const Records r = bodeflow::test::noisy(system.clean(random, 1000), random, system.input_noise, system.ratio);
    const auto scan = scan_orders(*lines_of(r.input, r.output), system.ratio, 10);
    REQUIRE(scan);
    right += scan->chosen == 2 ? 1 : 0;
  }
  CHECK(right >= 48);
}

TEST_CASE("koopmans_levin: above the true order the two smallest eigenvalues come together") {
  const Example1 system;
  Random random(92);
  const Records r = bodeflow::test::noisy(system.clean(random, 4000), random, system.input_noise, system.ratio);
  const auto scan = scan_orders(*lines_of(r.input, r.output), system.ratio, 5);
  REQUIRE(scan);
  REQUIRE(scan->orders.size() == 5);
  CHECK(scan->orders[1].ratio > 1.8);
  CHECK(scan->orders[2].ratio < 1.1);
  CHECK(scan->orders[0].noise > 1.5 * scan->orders[1].noise);
  CHECK(scan->orders[1].noise == Approx(0.1).epsilon(0.08));
}

TEST_CASE("koopmans_levin: without noise the scan ends at the true order") {
  const Example1 system;
  Random random(93);
  const Records r = system.clean(random, 400);
  const auto scan = scan_orders(*lines_of(r.input, r.output), system.ratio, 6);
  REQUIRE(scan);
  CHECK(scan->chosen == 2);
  CHECK(scan->orders.size() == 2);
}

TEST_CASE("koopmans_levin: a scan that ends below the true order chooses none") {
  const Example2 system;
  Random random(94);
  const Records r = bodeflow::test::noisy(system.clean(random, 4000), random, 1e-4, system.ratio);
  const auto scan = scan_orders(*lines_of(r.input, r.output), system.ratio, 3);
  REQUIRE(scan);
  CHECK(scan->chosen == 0);
  const auto wide = scan_orders(*lines_of(r.input, r.output), system.ratio, 6);
  CHECK(wide->chosen == 4);
}
