#include "iir_parameters.hpp"

#include <numbers>

namespace bodeflow::filters {
namespace {

using numerics::FilterKind;

constexpr std::pair<const char*, FilterKind> kFamilies[] = {{"butterworth", FilterKind::butterworth},
                                                            {"chebyshev_1", FilterKind::chebyshev_1},
                                                            {"chebyshev_2", FilterKind::chebyshev_2},
                                                            {"bessel", FilterKind::bessel},
                                                            {"elliptic", FilterKind::elliptic}};

}  // namespace

void describe_family(Describe& d) {
  d.parameter("family", "butterworth")
      .choices({"butterworth", "chebyshev_1", "chebyshev_2", "bessel", "elliptic"})
      .doc(
          "an edge is where the gain is -3 dB (butterworth, bessel), -ripple (chebyshev_1, elliptic), -attenuation "
          "(chebyshev_2)");
  d.parameter("order", std::int64_t{4})
      .range(1, numerics::kMostFilterOrder)
      .doc("of the low-pass filter it is made from; band filters have twice as many poles");
  d.parameter("ripple", 0.5).unit("dB").range(1e-4, 20).doc("in the pass band, of chebyshev_1 and elliptic");
  d.parameter("attenuation", 60.0).unit("dB").range(5, 200).doc("in the stop band, of chebyshev_2 and elliptic");
  d.parameter("method", "bilinear")
      .choices({"bilinear", "impulse_invariance"})
      .doc("how the continuous-time filter becomes a discrete-time one; bilinear: edges pre-warped");
  d.reference("T. W. Parks, C. S. Burrus, Digital Filter Design, 1987");
  d.reference("A. Kallen, Frequency Domain Adaptive Control, 1992, section 6.2");
}

numerics::IirDesign read_family(const Parameters& p) {
  numerics::IirDesign design;
  for (const auto& [name, kind] : kFamilies) {
    if (p.text("family") == name) design.kind = kind;
  }
  design.order = static_cast<int>(p.integer("order"));
  design.ripple_db = p.number("ripple");
  design.attenuation_db = p.number("attenuation");
  design.impulse_invariant = p.text("method") == "impulse_invariance";
  return design;
}

std::string family_text(const numerics::IirDesign& design) {
  std::string name;
  for (const auto& [known, kind] : kFamilies) {
    if (design.kind == kind) name = known;
  }
  return name + " filter of order " + std::to_string(design.order) + (design.impulse_invariant ? ", impulse-invariant" : "");
}

double angle(double frequency_hz, double rate_hz) { return 2 * std::numbers::pi * frequency_hz / rate_hz; }

}  // namespace bodeflow::filters
