#include "declared_timing.hpp"

#include <cstdio>

namespace bodeflow::residual {

void describe_timing(Describe& d, Hold usual) {
  const char* fallback = usual == Hold::zero_order ? "zero_order" : usual == Hold::first_order ? "first_order" : "band_limited";
  d.parameter("hold", fallback)
      .choices({"zero_order", "first_order", "band_limited"})
      .doc(
          "the input between its samples: held (a command), straight, or what its spectrum says (measured behind an anti-alias "
          "filter)");
  d.parameter("delay", 0.0).unit("s").range(0.0, 1e6).doc("from the sample of the input to the instant it acts");
}

Timing read_timing(const Parameters& p) {
  Timing timing;
  const std::string& hold = p.text("hold");
  timing.hold = hold == "zero_order" ? Hold::zero_order : hold == "first_order" ? Hold::first_order : Hold::band_limited;
  timing.delay_s = p.number("delay");
  return timing;
}

std::vector<std::string> timing_words(const Timing& timing) {
  std::vector<std::string> words;
  if (timing.hold == Hold::zero_order) words.emplace_back("the input is held over each sample (zero-order hold)");
  if (timing.hold == Hold::first_order) words.emplace_back("the input runs straight from sample to sample (first-order hold)");
  if (timing.hold == Hold::band_limited)
    words.emplace_back("the input between its samples is what its spectrum says (measured behind an anti-alias filter)");
  if (timing.delay_s > 0.0) words.push_back("the input acts " + short_text(1e6 * timing.delay_s) + " us after its sample");
  return words;
}

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace bodeflow::residual
