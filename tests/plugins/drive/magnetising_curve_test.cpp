#include "drive/magnetising_curve.hpp"

#include <cmath>

#include "catch.hpp"

using bodeflow::drive::MagnetisingCurve;

TEST_CASE("magnetising curve: the table solves a i + g psi(i) = M to 1e-12, from nothing to far beyond saturation") {
  const double lm = 0.454, isat = 1.2, share = 0.75;
  const double networks[][2] = {{1.0, 2.0 / 0.021}, {0.0, 1.0}, {1.0, 3.0}};
  for (const auto& [a, g] : networks) {
    const MagnetisingCurve curve(lm, isat, share, a, g);
    for (int k = 0; k < 2000; ++k) {
      const double i = 1e-4 * std::pow(1.01, k % 1000) * (k < 1000 ? 1.0 : 1.7);
      const double psi = lm * (0.25 * i + 0.75 * isat * std::tanh(i / isat)), m = a * i + g * psi;
      if (std::abs(curve.current_share(m) * m - i) > 1e-12 * m + 1e-14 * i) {
        CAPTURE(a, g, i);
        CHECK(curve.current_share(m) * m == Approx(i).epsilon(1e-12));
      }
      CHECK(curve.flux(i) == Approx(psi).epsilon(1e-14));
    }
    CHECK(curve.current_share(0.0) == Approx(1.0 / (a + g * lm)).epsilon(1e-14));
  }
}
