#include "bodeflow/numerics/iir_design.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "catch.hpp"
#include "plugins/reference_file.hpp"

using namespace bodeflow::numerics;
using bodeflow::test::Json;
using bodeflow::test::reference_file;

namespace {

constexpr double kPi = std::numbers::pi;

IirDesign design_of(const Json& entry) {
  static const std::map<std::string, FilterKind> kinds{{"butterworth", FilterKind::butterworth},
                                                       {"chebyshev_1", FilterKind::chebyshev_1},
                                                       {"chebyshev_2", FilterKind::chebyshev_2},
                                                       {"bessel", FilterKind::bessel},
                                                       {"elliptic", FilterKind::elliptic}};
  static const std::map<std::string, Pass> passes{
      {"low", Pass::low}, {"high", Pass::high}, {"band", Pass::band}, {"stop", Pass::stop}};
  IirDesign d;
  d.kind = kinds.at(entry["kind"]);
  d.pass = passes.at(entry["pass"]);
  d.order = entry["order"];
  for (std::size_t i = 0; i < entry["edges"].size(); ++i) d.edges[i] = entry["edges"][i];
  d.ripple_db = 0.5;
  d.attenuation_db = 50;
  return d;
}

double gain(const IirDesign& d, double w_h) { return std::abs(response(design_iir(d)->sections, w_h)); }

std::string refusal(const IirDesign& d) { return design_iir(d).error().text; }

}  // namespace

TEST_CASE("filters by bilinear transformation have the responses of the reference, five families, four passes, orders to 8") {
  const Json reference = reference_file("filters/iir.json");
  const auto angles = reference["angles"].get<std::vector<double>>();
  for (const Json& entry : reference["bilinear"]) {
    const auto filter = design_iir(design_of(entry));
    INFO(entry["kind"] << " " << entry["pass"] << " " << entry["order"]);
    REQUIRE(filter);
    const Eigen::VectorXcd expected = bodeflow::test::complex_vector_of(entry);
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const double difference = std::abs(response(filter->sections, angles[k]) - expected[static_cast<Eigen::Index>(k)]);
      CHECK(difference < 2e-11);
    }
  }
  CHECK(reference["bilinear"].size() == 120);
}

TEST_CASE("impulse-invariant filters have the sampled impulse response of their prototype") {
  for (const Json& entry : reference_file("filters/iir.json")["impulse_invariant"]) {
    IirDesign d = design_of(entry);
    d.impulse_invariant = true;
    const auto filter = design_iir(d);
    INFO(entry["kind"] << " " << entry["pass"] << " " << entry["order"]);
    REQUIRE(filter);
    const auto expected = entry["impulse"].get<std::vector<double>>();
    const Eigen::VectorXd h = impulse_response(filter->sections, static_cast<Eigen::Index>(expected.size()));
    for (std::size_t n = 0; n < expected.size(); ++n) CHECK(std::abs(h[static_cast<Eigen::Index>(n)] - expected[n]) < 1e-12);
  }
}

TEST_CASE("edges lie where they were asked for, after pre-warping") {
  for (const double edge : {0.01, 0.5, 2.5}) {
    CHECK(gain({FilterKind::butterworth, Pass::low, 5, {edge}}, edge) == Approx(std::sqrt(0.5)).epsilon(1e-10));
    CHECK(gain({FilterKind::bessel, Pass::high, 4, {edge}}, edge) == Approx(std::sqrt(0.5)).epsilon(1e-10));
    CHECK(gain({FilterKind::chebyshev_1, Pass::low, 6, {edge}, 0.7}, edge) == Approx(std::pow(10, -0.7 / 20)).epsilon(1e-10));
    CHECK(gain({FilterKind::chebyshev_2, Pass::low, 6, {edge}, 1, 55}, edge) == Approx(std::pow(10, -55. / 20)).epsilon(1e-8));
    CHECK(gain({FilterKind::elliptic, Pass::low, 5, {edge}, 0.3, 70}, edge) == Approx(std::pow(10, -0.3 / 20)).epsilon(1e-9));
  }
}

TEST_CASE("an elliptic filter ripples between its bounds in pass band and stop band, a Butterworth filter falls all the way") {
  for (const int order : {3, 4, 7, 12}) {
    const Sections sections = design_iir({FilterKind::elliptic, Pass::low, order, {1.0}, 0.5, 60})->sections;
    double least_pass = 1, most_pass = 0;
    for (int k = 0; k <= 2000; ++k) {
      const double g = std::abs(response(sections, k / 2000.0));
      least_pass = std::min(least_pass, g);
      most_pass = std::max(most_pass, g);
    }
    CHECK(least_pass == Approx(std::pow(10, -0.5 / 20)).epsilon(1e-5));
    CHECK(most_pass == Approx(1).epsilon(1e-5));
    // Behind the first point below 60 dB it never comes back above.
    bool stopped = false;
    double back = 0;
    for (int k = 0; k <= 20000; ++k) {
      const double g = std::abs(response(sections, 1 + (kPi - 1) * k / 20000));
      stopped = stopped || g < 1e-3;
      if (stopped) back = std::max(back, g);
    }
    CHECK(back == Approx(1e-3).epsilon(1e-4));
  }
  double last = 2;
  for (int k = 0; k <= 300; ++k) {
    const double g = gain({FilterKind::butterworth, Pass::low, 4, {0.7}}, kPi * k / 300);
    CHECK(g < last);
    last = g;
  }
}

TEST_CASE("the polynomials of Bessel filters of unit product are those of Kallen's section 7.3") {
  const auto coefficients = [](int order) { return to_transfer_function(*bessel_of_unit_product(order))->denominator; };
  CHECK((coefficients(2) - Eigen::Vector3d(1, 1.732051, 1)).norm() < 1e-6);
  CHECK((coefficients(3) - Eigen::Vector4d(1, 2.432881, 2.466212, 1)).norm() < 1e-6);
  Eigen::VectorXd five(6);
  five << 1, 3.810701, 6.776674, 6.886368, 3.936283, 1;
  CHECK((coefficients(5) - five).norm() < 2e-6);
}

TEST_CASE("a filter of order 16 still has its pass band, and its sections run stable") {
  for (const auto kind :
       {FilterKind::butterworth, FilterKind::chebyshev_1, FilterKind::chebyshev_2, FilterKind::bessel, FilterKind::elliptic}) {
    const auto filter = design_iir({kind, Pass::band, 16, {0.5, 1.0}, 0.1, 80});
    REQUIRE(filter);
    CHECK(filter->sections.size() == 16);
    CHECK(filter->roots.poles.cwiseAbs().maxCoeff() < 1);
    const Eigen::VectorXd h = impulse_response(filter->sections, 60000);
    std::complex<double> sum = 0;
    for (Eigen::Index n = 0; n < h.size(); ++n) sum += std::polar(h[n], -0.7 * static_cast<double>(n));
    CHECK(std::abs(sum - response(filter->sections, 0.7)) < 1e-8);
  }
}

TEST_CASE("sections with one real pole are of order one, and filters without zeros begin with their delay") {
  const Sections sections = design_iir({FilterKind::butterworth, Pass::low, 3, {0.5}})->sections;
  REQUIRE(sections.size() == 2);
  CHECK(sections[0].a2 == 0);
  CHECK(sections[0].b2 == 0);
  ZeroPoleGain delayed;
  delayed.poles = Eigen::Vector2cd(0.5, -0.25);
  delayed.zeros.resize(0);
  delayed.gain = 3;
  delayed.sample_time = 1;
  const Eigen::VectorXd h = impulse_response(*to_sections(delayed), 4);
  CHECK(h[0] == 0);
  CHECK(h[1] == 0);
  CHECK(h[2] == 3);
  CHECK(h[3] == 0.75);
}

TEST_CASE("designs that cannot be are refused with what is allowed") {
  using enum FilterKind;
  CHECK(refusal({butterworth, Pass::low, 0, {1.0}}) == "order 0: allowed are 1 to 16");
  CHECK(refusal({butterworth, Pass::low, 17, {1.0}}) == "order 17: allowed are 1 to 16");
  CHECK(refusal({butterworth, Pass::low, 4, {0.0}}) == "the edge w h = 0 rad must lie between 0 and pi (the Nyquist frequency)");
  CHECK(refusal({butterworth, Pass::low, 4, {3.2}}) ==
        "the edge w h = 3.2 rad must lie between 0 and pi (the Nyquist frequency)");
  CHECK(refusal({butterworth, Pass::band, 4, {1.0, 0.5}}) == "the lower edge of the band must lie below the upper one");
  CHECK(refusal({chebyshev_1, Pass::low, 4, {1.0}, 0.0}) == "the ripple must be 0.0001 to 20 dB");
  CHECK(refusal({chebyshev_2, Pass::low, 4, {1.0}, 1, 300}) == "the attenuation must be 5 to 200 dB");
  CHECK(refusal({elliptic, Pass::low, 4, {1.0}, 10, 9}) == "the attenuation must be larger than the ripple");
  CHECK(refusal({butterworth, Pass::low, 16, {1e-7}}).find("the edges lie too near zero or to each other for order 16") == 0);
  CHECK(refusal({butterworth, Pass::high, 4, {1.0}, 1, 60, true}) ==
        "impulse invariance is for low-pass and band-pass filters: what passes above the Nyquist frequency would fold down");
  CHECK(refusal({elliptic, Pass::low, 4, {1.0}, 1, 60, true}) ==
        "impulse invariance is for butterworth, chebyshev_1 and bessel: the others do not fall off above their stop band");
  CHECK(refusal({butterworth, Pass::low, 9, {1.0}, 1, 60, true}) == "impulse invariance of order 9: allowed are 1 to 8");
  CHECK(
      refusal({butterworth, Pass::low, 2, {2.0}, 1, 60, true}) ==
      "impulse invariance: the continuous-time filter still has the gain 0.375609 at the Nyquist frequency and would fold down; "
      "allowed is up to 0.1: lower edges, a higher order, or the bilinear transformation");
  ZeroPoleGain unstable;
  unstable.poles = Eigen::VectorXcd::Constant(1, 1.0);
  unstable.sample_time = 1;
  CHECK(to_sections(unstable).error().text == "the filter has a pole on or outside the unit circle");
}
