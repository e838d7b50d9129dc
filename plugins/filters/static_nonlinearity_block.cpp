#include "static_nonlinearity_block.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "static_nonlinearity.hpp"

namespace bodeflow::filters {

void StaticNonlinearity::describe(Describe& d) {
  d.id("filters.static_nonlinearity")
      .summary("Bends each sample by a polynomial, and limits it.")
      .realtime_safe()
      .in_place()
      .cost_ns(1);
  d.doc(
      "y[n] = c0 + c1 x[n] + c2 x[n]^2 + ..., no smaller than `least` and no larger than `greatest`. What a real amplifier, "
      "sensor or spring "
      "does beside being linear: even powers make even distortion (and an offset), odd ones odd distortion, which bends the best "
      "linear "
      "approximation as well: for a Gaussian x of standard deviation s, c1 x + c3 x^3 has the best linear gain c1 + 3 c3 s^2. A "
      "sampled x "
      "folds what the powers make above the Nyquist frequency.");
  d.reference("R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapter 3");
  d.parameter("coefficients", std::vector<double>{0.0, 1.0}).unit("").doc("c0, c1, c2 ... of rising powers");
  d.optional<double>("least").unit("").doc("smallest output; without it there is no lower limit");
  d.optional<double>("greatest").unit("").doc("largest output; without it there is no upper limit");
  d.optional<std::string>("unit").doc("unit of the output; that of the input where it is left out");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
}

void StaticNonlinearity::configure(const Parameters& p) {
  coefficients_ = p.numbers("coefficients");
  if (coefficients_.empty()) fail("coefficients: none; needed: at least c0");
  for (const double c : coefficients_) {
    if (!std::isfinite(c)) fail("coefficients: not all are finite");
  }
  constexpr double kNone = std::numeric_limits<double>::infinity();
  least_ = p.has("least") ? p.number("least") : -kNone;
  greatest_ = p.has("greatest") ? p.number("greatest") : kNone;
  if (!(least_ <= greatest_)) {
    std::ostringstream text;
    text << "least " << least_ << " is above greatest " << greatest_;
    fail(text.str());
  }
  has_unit_ = p.has("unit");
  if (has_unit_) unit_ = p.text("unit");
}

void StaticNonlinearity::resolve(Facts& f) {
  if (!f.out(out).known) return;
  // Neither amplitudes, noise nor crest factor come through unchanged; the period and the plant before it do.
  for (const char* changed : {"excitation.amplitudes", "excitation.crest_factor", "noise.std"}) f.out(out).notes.erase(changed);
  if (!has_unit_) return;
  f.out(out).unit = unit_;
  f.out(out).channel_units.clear();
}

void StaticNonlinearity::process(Io& io) {
  for (int c = 0; c < io.channels(in); ++c) {
    const auto x = io.read(in, c);
    const auto y = io.write(out, c);
    for (std::size_t n = 0; n < x.size(); ++n) y[n] = limited(polynomial(coefficients_, x[n]), least_, greatest_);
  }
}

}  // namespace bodeflow::filters
