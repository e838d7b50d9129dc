#include "bodeflow/numerics/fir_design.hpp"

#include <cmath>
#include <map>

#include "bodeflow/numerics/fir.hpp"
#include "catch.hpp"
#include "plugins/reference_file.hpp"

using namespace bodeflow::numerics;
using bodeflow::test::Json;
using bodeflow::test::vector_of;

namespace {

WindowDesign design_of(const Json& entry) {
  static const std::map<std::string, Window> windows{{"rectangular", Window::rectangular},
                                                     {"hann", Window::hann},
                                                     {"hamming", Window::hamming},
                                                     {"blackman", Window::blackman},
                                                     {"kaiser", Window::kaiser}};
  static const std::map<std::string, Pass> passes{
      {"low", Pass::low}, {"high", Pass::high}, {"band", Pass::band}, {"stop", Pass::stop}};
  WindowDesign d;
  d.pass = passes.at(entry["pass"]);
  d.taps = static_cast<int>(entry["taps"].size());
  for (std::size_t i = 0; i < entry["edges"].size(); ++i) d.edges[i] = entry["edges"][i];
  d.shape = windows.at(entry["window"]);
  d.beta = 6;
  return d;
}

std::vector<Band> bands_of(const Json& entry) {
  std::vector<Band> bands;
  for (std::size_t i = 0; i < entry["weights"].size(); ++i) {
    bands.push_back({entry["bands"][2 * i], entry["bands"][2 * i + 1], entry["desired"][2 * i], entry["desired"][2 * i + 1],
                     entry["weights"][i]});
  }
  return bands;
}

// The cost of a least-squares design, by a fine sum.
double cost(const Eigen::VectorXd& taps, const std::vector<Band>& bands) {
  constexpr int kPoints = 2000;
  const double delay = 0.5 * static_cast<double>(taps.size() - 1);
  double sum = 0;
  for (const Band& b : bands) {
    for (int k = 0; k < kPoints; ++k) {
      const double at = (k + 0.5) / kPoints, f = b.low + (b.high - b.low) * at;
      const std::complex<double> h = fir_response(taps, f) * std::polar(1.0, std::numbers::pi * f * delay);
      sum += b.weight * std::norm(h - (b.from + (b.to - b.from) * at)) * (b.high - b.low) / kPoints;
    }
  }
  return sum;
}

const std::string& refusal(const Expected<Eigen::VectorXd>& filter) { return filter.error().text; }

}  // namespace

TEST_CASE("linear-phase filters by window and by least squares are those of the reference") {
  for (const Json& entry : bodeflow::test::reference_file("filters/fir.json")) {
    const Eigen::VectorXd expected = vector_of(entry["taps"]);
    const bool by_window = entry["method"] == "window";
    const auto taps =
        by_window ? fir_by_window(design_of(entry)) : fir_by_least_squares(static_cast<int>(expected.size()), bands_of(entry));
    INFO(entry.dump().substr(0, 120));
    REQUIRE(taps);
    CHECK((*taps - expected).cwiseAbs().maxCoeff() < (by_window ? 1e-15 : 1e-12) * 10);
  }
}

TEST_CASE("a least-squares filter of even length is a minimum of its cost") {
  const std::vector<Band> bands{{0, 0.3, 1, 1, 1}, {0.4, 0.6, 0, 0, 20}, {0.7, 1, 0.5, 0, 3}};
  const Eigen::VectorXd best = *fir_by_least_squares(24, bands);
  CHECK((best - best.reverse()).cwiseAbs().maxCoeff() == 0);
  const double least = cost(best, bands);
  for (Eigen::Index j = 0; j < 12; ++j) {
    for (const double step : {1e-3, -1e-3}) {
      Eigen::VectorXd other = best;
      other[j] += step;
      other[23 - j] += step;
      CHECK(cost(other, bands) > least);
    }
  }
}

TEST_CASE("a long least-squares filter with a wide gap stays small in the gap") {
  const Eigen::VectorXd taps = *fir_by_least_squares(401, {{0, 0.2, 1, 1, 1}, {0.6, 1, 0, 0, 1}});
  double most = 0;
  for (int k = 0; k <= 400; ++k) most = std::max(most, std::abs(fir_response(taps, 0.2 + 0.4 * k / 400)));
  CHECK(most < 1.5);
  CHECK(std::abs(fir_response(taps, 0.1)) == Approx(1).epsilon(1e-6));
  CHECK(std::abs(fir_response(taps, 0.8)) < 1e-6);
}

TEST_CASE("linear-phase designs that cannot be are refused with what is allowed") {
  CHECK(refusal(fir_by_window({Pass::low, 0, {0.5}})) == "0 taps: allowed are 1 to 65536");
  CHECK(refusal(fir_by_window({Pass::high, 20, {0.5}})) ==
        "20 taps: a symmetric filter with an even number of them is 0 at the Nyquist frequency; allowed here: odd");
  CHECK(refusal(fir_by_window({Pass::low, 21, {1.5}})) == "the edge at 1.5 of the Nyquist frequency: allowed is between 0 and 1");
  CHECK(refusal(fir_by_window({Pass::band, 21, {0.5, 0.4}})) == "the lower edge of the band must lie below the upper one");
  CHECK(refusal(fir_by_window({Pass::low, 21, {0.5}, Window::kaiser, -1})) == "the Kaiser window's beta must be 0 to 50");
  CHECK(refusal(fir_by_least_squares(2000, {{0, 1, 1, 1, 1}})) == "2000 taps: allowed are 1 to 1025");
  CHECK(refusal(fir_by_least_squares(21, {})) == "a least-squares filter needs at least one band");
  CHECK(refusal(fir_by_least_squares(21, {{0.4, 0.3, 1, 1, 1}})) ==
        "the band 0.4 to 0.3 of the Nyquist frequency: allowed are 0 <= low < high <= 1");
  CHECK(refusal(fir_by_least_squares(21, {{0, 0.5, 1, 1, 1}, {0.4, 1, 0, 0, 1}})) ==
        "the band 0.4 to 1 of the Nyquist frequency begins below the end of the one before");
  CHECK(refusal(fir_by_least_squares(21, {{0, 0.5, 1, 1, 0}})) ==
        "the band 0 to 0.5 of the Nyquist frequency has the weight 0, allowed: above 0");
  CHECK(refusal(fir_by_least_squares(20, {{0, 1, 1, 1, 1}})) ==
        "20 taps: a symmetric filter with an even number of them is 0 at the Nyquist frequency; allowed here: odd");
}
