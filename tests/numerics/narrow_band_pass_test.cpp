#include "bodeflow/numerics/narrow_band_pass.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <vector>

#include "catch.hpp"

using bodeflow::numerics::NarrowBandPass;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::vector<double> impulse_response(NarrowBandPass filter, std::size_t count) {
  std::vector<double> h(count);
  for (std::size_t k = 0; k < count; ++k) h[k] = filter.step(k == 0 ? 1.0 : 0.0);
  return h;
}

double group_delay(const NarrowBandPass& filter, double w_h) {
  const double step = 1e-5;
  return -std::arg(filter.response(w_h + step) / filter.response(w_h - step)) / (2 * step);
}

}  // namespace

TEST_CASE("narrow band-pass sections have the impulse responses of the reference within 1e-13") {
  std::ifstream file(BODEFLOW_TEST_DATA "/filters/narrow_band_pass_impulse.csv");
  std::string line;
  std::getline(file, line);
  REQUIRE(line == "k,w0.05,w0.10,w0.30,w0.50,w0.70,w1.00");
  std::vector<NarrowBandPass> filters;
  for (const double w_h : {0.05, 0.1, 0.3, 0.5, 0.7, 1.0}) filters.push_back(*NarrowBandPass::design(0.9, 2, 2 * kDegree, w_h));
  int k = 0;
  for (; std::getline(file, line); ++k) {
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    for (NarrowBandPass& filter : filters) {
      std::getline(cells, cell, ',');
      CHECK(std::abs(filter.step(k == 0 ? 1.0 : 0.0) - std::stod(cell)) < 1e-13);
    }
  }
  CHECK(k == 120);
}

TEST_CASE("the transform of a narrow band-pass's impulse response is its frequency response") {
  for (const int m : {1, 2, 3, 5}) {
    const NarrowBandPass filter = *NarrowBandPass::design(0.93, m, 2 * kDegree, 0.6);
    const std::vector<double> h = impulse_response(filter, 1200);
    for (const double w_h : {0.0, 0.2, 0.55, 0.6, 0.65, 1.5, 3.1}) {
      std::complex<double> sum = 0;
      for (std::size_t k = 0; k < h.size(); ++k) sum += std::polar(h[k], -w_h * static_cast<double>(k));
      CHECK(std::abs(sum - filter.response(w_h)) < 1e-12);
    }
  }
}

TEST_CASE("narrow band-pass filters have the gains and group delays of Kallen's section 6.4") {
  const auto at = [](double w_h) { return *NarrowBandPass::design(0.9, 2, 2 * kDegree, w_h); };
  CHECK(std::abs(at(0.05).response(0.05)) == Approx(0.512).margin(5e-4));
  CHECK(std::abs(at(0.1).response(0.1)) == Approx(0.849).margin(5e-4));
  CHECK(std::abs(at(1.0).response(1.0)) == Approx(1.077).margin(5e-4));
  CHECK(group_delay(at(0.05), 0.05) == Approx(28.6).margin(0.05));
  CHECK(group_delay(at(0.5), 0.5) == Approx(18.7).margin(0.05));
  // Figure 6.2: a filter of order 10 at 1 rad with a group delay of 40 samples.
  CHECK(group_delay(*NarrowBandPass::design(0.9, 5, 2 * kDegree, 1.0), 1.0) == Approx(40).margin(0.2));
}

TEST_CASE("the poles of a narrow band-pass lie evenly around the centre, m = 1 on it") {
  const NarrowBandPass three = *NarrowBandPass::design(0.9, 3, 0.1, 1.0);
  CHECK(three.section(0).phi == Approx(1.1));
  CHECK(three.section(1).phi == Approx(1.0));
  CHECK(three.section(2).phi == Approx(0.9));
  CHECK(NarrowBandPass::design(0.9, 1, 0.1, 1.0)->section(0).phi == 1.0);
}

TEST_CASE("reset takes a narrow band-pass back to a past of zeros") {
  NarrowBandPass filter = *NarrowBandPass::design(0.9, 2, 2 * kDegree, 0.4);
  const std::vector<double> fresh = impulse_response(filter, 10);
  for (int k = 0; k < 20; ++k) filter.step(1.0);
  filter.reset();
  CHECK(impulse_response(filter, 10) == fresh);
}

TEST_CASE("narrow band-pass designs that cannot be are refused with what is allowed") {
  const auto text = [](double r, int m, double dphi, double w_h) { return NarrowBandPass::design(r, m, dphi, w_h).error().text; };
  CHECK(text(1.0, 2, 0.03, 1) == "the pole radius r = 1 must lie between 0 and 1");
  CHECK(text(std::nan(""), 2, 0.03, 1) == "the pole radius r = nan must lie between 0 and 1");
  CHECK(text(0.9, 0, 0.03, 1) == "m = 0 sections: allowed are 1 to 16");
  CHECK(text(0.9, 2, -0.1, 1) == "the angle dphi = -0.1 rad between poles must be at least 0 and less than pi");
  CHECK(text(0.9, 3, 0.1, 0.1) ==
        "the centre w h = 0.1 rad is too near zero: a filter with m = 3 and dphi = 0.1 rad needs more than dphi (m - "
        "1) / "
        "2, at least 0.1001 rad");
  CHECK(text(0.9, 3, 0.1, 3.2) ==
        "the centre w h = 3.2 rad is too near the Nyquist frequency pi or above it: allowed is up to 3.04149 rad");
  CHECK(text(0.9, 1, 0, std::nan("")).starts_with("the centre w h = nan"));
}
