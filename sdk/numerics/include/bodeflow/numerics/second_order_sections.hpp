#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "bodeflow/numerics/linear_system.hpp"

/// Discrete-time filters as second-order sections in series: a polynomial of high order loses its digits, sections keep them.
namespace bodeflow::numerics {

/// (b0 z^2 + b1 z + b2) / (z^2 + a1 z + a2); a section of order 1 has b2 = a2 = 0.
struct Biquad {
  double b0 = 1.0;
  double b1 = 0.0;
  double b2 = 0.0;
  double a1 = 0.0;
  double a2 = 0.0;
};

using Sections = std::vector<Biquad>;

/// The sections of a discrete-time filter given by its roots: poles in conjugate pairs, real ones two by two, each with the zeros
/// nearest to it; the section with the poles nearest to the unit circle comes last, the gain stands in the first. Errors: a
/// continuous-time system, more zeros than poles, poles on or outside the unit circle, complex roots without their conjugates.
Expected<Sections> to_sections(const ZeroPoleGain& filter);

/// H(exp(j w_h)), w_h = w h in rad (h the sample time).
std::complex<double> response(const Sections& sections, double w_h);

/// The first `count` samples of the impulse response.
Eigen::VectorXd impulse_response(const Sections& sections, Eigen::Index count);

/// Sections that filter sample by sample, in transposed direct form II.
class SectionFilter {
 public:
  explicit SectionFilter(Sections sections) : sections_(std::move(sections)), states_(sections_.size()) {}

  /// y[n] for the next x[n]. Allocates nothing.
  double step(double x) {
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      const Biquad& k = sections_[i];
      State& s = states_[i];
      const double y = k.b0 * x + s.first;
      s.first = (k.b1 * x + s.second) - k.a1 * y;
      s.second = k.b2 * x - k.a2 * y;
      x = y;
    }
    return x;
  }

  /// Back to a past of zeros.
  void reset() { states_.assign(states_.size(), State{}); }

 private:
  struct State {
    double first = 0.0;
    double second = 0.0;
  };

  Sections sections_;
  std::vector<State> states_;
};

}  // namespace bodeflow::numerics
