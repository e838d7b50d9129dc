#include <cmath>
#include <vector>

#include "catch.hpp"
#include "effects/clipping.hpp"
#include "effects/drift.hpp"
#include "effects/gain_step.hpp"
#include "effects/input_clipping.hpp"
#include "effects/input_dead_zone.hpp"
#include "effects/input_nonlinearity.hpp"
#include "effects/input_offset.hpp"
#include "effects/offset.hpp"
#include "effects/output_nonlinearity.hpp"
#include "effects/play.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

template <class E>
double mapped(std::initializer_list<double> p, double x, double time_s = 0.0) {
  double memory[2] = {0.0, 0.0};
  return E().map(p.begin(), x, time_s, memory);
}

/// A signal through a play of half width r.
std::vector<double> played(const std::vector<double>& x, double r, double memory = 0.0) {
  std::vector<double> y;
  for (const double v : x) y.push_back(Play().map(&r, v, 0.0, &memory));
  return y;
}

}  // namespace

TEST_CASE("maps without memory: constants, limits, zones and powers") {
  CHECK(mapped<Offset>({0.3}, 2.0) == 2.3);
  CHECK(mapped<InputOffset>({-0.3}, 2.0) == 1.7);
  CHECK(mapped<Drift>({0.5, 0.1}, 2.0, 3.0) == Approx(3.6));
  CHECK(mapped<Clipping>({1.5}, -2.0) == -1.5);
  CHECK(mapped<Clipping>({1.5}, 1.4) == 1.4);
  CHECK(mapped<InputClipping>({1.5}, 2.0) == 1.5);
  CHECK(mapped<InputDeadZone>({0.5}, 0.4) == 0.0);
  CHECK(mapped<InputDeadZone>({0.5}, -2.0) == -1.5);
  CHECK(mapped<InputNonlinearity>({0.1, 0.01}, 2.0) == Approx(2.0 + 0.4 + 0.08));
  CHECK(mapped<OutputNonlinearity>({0.1, -0.01}, -2.0) == Approx(-2.0 + 0.4 + 0.08));
}

TEST_CASE("gain step: jumps at its instant, spread over the samples beside it so that the instant can be fitted") {
  const double p[] = {0.5, 1.0};
  double memory[2] = {0.0, 0.0};
  std::vector<double> y;
  for (int n = 0; n < 5; ++n) y.push_back(GainStep().map(p, 2.0, 0.8 + 0.1 * n, memory));
  CHECK(y[0] == 2.0);
  CHECK(y[1] == Approx(2.0));
  CHECK(y[2] == Approx(2.5));
  CHECK(y[3] == Approx(3.0));
  CHECK(y[4] == 3.0);
  // Moved by a tenth of a sample, the instant is seen.
  const double later[] = {0.5, 1.01};
  double other[2] = {0.9, 1.0};
  CHECK(GainStep().map(later, 2.0, 1.0, other) == Approx(2.4));
}

TEST_CASE("play: follows at its distance and rests where the movement turns around") {
  const std::vector<double> x = {0.0, 1.0, 3.0, 2.0, 1.5, 1.0, 0.0, 1.0, 2.0, 2.5};
  CHECK(played(x, 1.0) == std::vector<double>{0.0, 0.0, 2.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.5});
}

TEST_CASE("play: a loop within a loop closes and is forgotten, and loops between the same turns are congruent") {
  // Out to 5, back to 2, out to 5: the point of return is reached again (wiping out).
  const std::vector<double> with = played({0, 3, 5, 4, 2, 3, 5, 6}, 0.7), without = played({0, 3, 5, 6}, 0.7);
  CHECK(with[6] == without[2]);
  CHECK(with.back() == without.back());
  // The same turns after different histories: the readings differ by a constant.
  const std::vector<double> turns = {2.0, 3.0, 2.0, 2.5, 3.0, 2.0};
  const std::vector<double> a = played(turns, 0.7, 3.0), b = played(turns, 0.7, 1.0);
  for (std::size_t i = 2; i < turns.size(); ++i) CHECK(a[i] - b[i] == Approx(a[1] - b[1]).margin(1e-12));
}
