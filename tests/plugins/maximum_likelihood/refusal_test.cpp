#include <limits>

#include "catch.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

const Eigen::VectorXd kOmega = 2.0 * std::numbers::pi * even_spaced(1.0, 20.0, 20);

Spectra example() {
  const Eigen::MatrixXcd g = response_of(ladder(2, kOmega, 0.0, 0.0), kOmega);
  return spectra_of(kOmega, g, 1e-4 * g.cwiseAbs2());
}

std::string refusal(const Spectra& s, const Settings& asked) {
  const auto id = identify(s, asked);
  return id ? "none" : id.error().text;
}

}  // namespace

TEST_CASE("maximum likelihood: data that can't be used are refused with the line") {
  const Settings asked = settings(Domain::s, 2);
  CHECK(refusal(example(), asked) == "none");
  Spectra s = example();
  s.output(4, 0) = {0.0, std::numeric_limits<double>::quiet_NaN()};
  CHECK(refusal(s, asked) == "the output is not finite at line 5 of 20 (5.000000 Hz)");
  s = example();
  s.output_variance(4, 0) = 0.0;
  CHECK(refusal(s, asked) ==
        "the variance is zero at line 5 of 20 (5.000000 Hz): no line can weigh infinitely; leave the line out by `band`, or "
        "measure "
        "more periods");
  s = example();
  s.output_variance(0, 0) = -1.0;
  CHECK(refusal(s, asked) == "the variance is negative at line 1 of 20 (1.000000 Hz)");
  s = example();
  s.input[19] = 0.0;
  CHECK(refusal(s, asked) == "the input is zero at line 20 of 20 (20.000000 Hz)");
  s = example();
  s.omega_rad_s[3] = s.omega_rad_s[2];
  CHECK(refusal(s, asked) == "the frequencies do not rise at line 4 of 20 (3.000000 Hz)");
  CHECK(refusal(part_within(example(), 1000.0, 2000.0), asked) == "there are no lines to fit");
}

TEST_CASE("maximum likelihood: models that the data can't give are refused with the numbers") {
  CHECK(refusal(part_within(example(), 0.0, 13.0), settings(Domain::s, 2)) ==
        "2 lines are too few for 4 parameters: each complex line and output gives two equations, and more than 4 are needed; "
        "lower the "
        "order or measure more lines");
  CHECK(refusal(example(), settings(Domain::z, 2)) ==
        "the domain z needs the sample rate of the data, and the response does not have it; choose domain: s");
  Settings s = settings(Domain::s, 2);
  s.zero_order_hold = true;
  CHECK(refusal(example(), s) == "hold: zero_order needs the sample rate of the data, and the response does not have it");
  s = settings(Domain::s, 31);
  CHECK(refusal(example(), s) == "an order of 31; allowed: 0 to 30");
  Spectra sampled = example();
  sampled.sample_time_s = 0.01;
  s = settings(Domain::z, 2);
  s.numerator_orders = {3};
  CHECK(refusal(sampled, s) == "the numerator order 3 is above the order 2: such a model of z answers before it is excited");
  s = settings(Domain::s, 2);
  s.numerator_orders = {1, 1};
  CHECK(refusal(example(), s) == "numerator_order has 2 values for 1 outputs; allowed: one for all, or one each");
}

TEST_CASE("maximum likelihood: what can't be fixed is refused by its name") {
  Settings s = settings(Domain::s, 2);
  s.fixed_poles = list({0.0, 0.0, 0.0});
  CHECK(refusal(example(), s) == "3 fixed poles in a model of order 2");
  s.fixed_poles = list({Complex(0.0, 3.0)});
  CHECK(refusal(example(), s) == "fixed poles: the root 0+3i stands without its conjugate 0-3i");
  s.fixed_poles = list({Complex(0.0, kOmega[6]), Complex(0.0, -kOmega[6])});
  CHECK(refusal(example(), s) == "the line at 7.000000 Hz lies on a fixed pole; leave it out by `band`");
  s = settings(Domain::s, 2);
  s.fixed = {{true, 0, 2, 1.0}};
  CHECK(refusal(example(), s) == "the fixed coefficient a2: the highest coefficient of the denominator is 1 already");
  s.fixed = {{false, 0, 4, 1.0}};
  CHECK(refusal(example(), s) == "the fixed coefficient b4: the highest one is b1");
  s.fixed = {{true, 0, 1, 1.0}, {true, 0, 1, 2.0}};
  CHECK(refusal(example(), s) ==
        "no start for a search: the fixed coefficients contradict each other: they leave the denominator without its highest "
        "coefficient");
  s.fixed = {{true, 0, 1, 1.0}, {true, 0, 1, 1.0}};
  CHECK(refusal(example(), s) == "no start for a search: the fixed coefficients repeat each other");
}
