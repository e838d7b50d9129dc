// One hundred windings of which one section is deformed, with two unchanged phases each.
#include <Eigen/Eigenvalues>
#include <iostream>

#include "catch.hpp"
#include "validation/change.hpp"
#include "windings.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

namespace {

struct Tally {
  int bands = 0, modes = 0, controls = 0, pairs = 0;
};

std::vector<double> resonances(const plants::Ladder& ladder) {
  std::vector<double> f;
  for (const auto& p : plants::ladder_system(ladder)->A.eigenvalues())
    if (p.imag() > 0.0) f.push_back(std::abs(p) / (2.0 * M_PI));
  std::sort(f.begin(), f.end());
  return f;
}

/// The mode that has moved most within the lines.
std::size_t most_moved(const std::vector<double>& before, const std::vector<double>& after) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < before.size(); ++i)
    if (std::abs(after[i] / before[i] - 1.0) > std::abs(after[most] / before[most] - 1.0)) most = i;
  return most;
}

bool band_found(const EntryChange& e, double f) {
  for (const BandChange& b : e.spectrum.bands)
    if (f >= b.low_hz && f <= b.high_hz) return b.verdict == Verdict::changed;
  return false;
}

/// Moved, with an interval of 4 deviations that holds the truth.
bool mode_found(const EntryChange& e, double before, double after) {
  for (const ModeChange& m : e.modes) {
    if (m.status != ModeStatus::moved || std::abs(m.before->frequency_hz() / before - 1.0) > 0.02) continue;
    return std::abs(m.frequency_shift - (after / before - 1.0)) < 4.0 * m.frequency_shift_deviation;
  }
  return false;
}

/// seed: of the winding, of the place and size (2 to 10 %) of its deformation, of the noise.
void judge(std::uint64_t seed, Tally& tally) {
  const auto f = frequencies(250);
  numerics::Random random(1000 + seed);
  const auto l = winding(5, seed);
  auto d = l;
  const auto section = static_cast<std::size_t>(5.0 * random.uniform());
  d.earth_capacitance_f[section] *= 1.02 + 0.08 * random.uniform();
  const auto changed = response_change(measured(l, f, 3 * seed), measured(d, f, 3 * seed + 1), {}, {});
  REQUIRE(changed);
  const auto before = resonances(l), after = resonances(d);
  const std::size_t most = most_moved(before, after);
  tally.bands += band_found(changed->entries[0], before[most]) ? 1 : 0;
  tally.modes += mode_found(changed->entries[0], before[most], after[most]) ? 1 : 0;
  for (std::uint64_t phase = 1; phase <= 2; ++phase) {
    const auto control = winding(5, 5000 + 2 * seed + phase);
    ChangeSettings bands_alone;
    bands_alone.find_modes = false;
    const auto same = response_change(measured(control, f, 7000 + 4 * seed + phase),
                                      measured(control, f, 9000 + 4 * seed + phase), {}, bands_alone);
    REQUIRE(same);
    tally.controls += same->verdict == Verdict::unchanged ? 1 : 0;
  }
  ++tally.pairs;
}

}  // namespace

TEST_CASE("change: two deformed windings are found, their unchanged phases are not") {
  Tally t;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) judge(seed, t);
  CHECK(t.bands == 2);
  CHECK(t.modes == 2);
  CHECK(t.controls == 4);
}

TEST_CASE("change: of one hundred deformed windings 95 are found and 97 percent of unchanged phases stay unchanged", "[long]") {
  Tally t;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) judge(seed, t);
  std::cout << "changed band found in " << t.bands << ", moved mode in " << t.modes << " of " << t.pairs << ", unchanged "
            << t.controls << " of " << 2 * t.pairs << "\n";
  CHECK(t.bands >= 95);
  CHECK(t.modes >= 95);
  CHECK(t.controls >= 194);
}
