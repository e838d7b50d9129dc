#include "source.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::generators {

void describe_source(Describe& d) {
  d.required<double>("sample_rate").unit("Hz").range(1e-6, kMaxRateHz).doc("samples per second");
  d.parameter("unit", "").doc("unit of the stream, such as V; the numbers of this block are in it");
}

Rate source_rate(const Parameters& p) {
  const double hz = p.number("sample_rate");
  const Rate rate = Rate::from_hz(hz);
  if (!rate.known()) fail("sample_rate " + hertz(hz) + " is not a fraction of whole numbers that the engine can hold");
  return rate;
}

StreamFacts source_facts(Rate rate, const std::string& unit, int channels, std::int64_t length) {
  StreamFacts facts;
  facts.known = true;
  facts.channels = channels;
  facts.rate = rate;
  facts.length = length;
  facts.unit = unit;
  return facts;
}

std::uint64_t first_sample(double time_s, Rate rate) {
  const double place = time_s * rate.hz();
  if (!(place >= 0 && place < 9e18)) fail("a time of " + std::to_string(time_s) + " s is no countable sample");
  const double nearest = std::round(place);
  return static_cast<std::uint64_t>(std::abs(place - nearest) <= 1e-6 + 1e-15 * place ? nearest : std::ceil(place));
}

std::size_t before_end(Io& io, std::int64_t length) {
  if (length < 0) return static_cast<std::size_t>(io.count());
  const auto end = static_cast<std::uint64_t>(length);
  const std::uint64_t left = end > io.position() ? end - io.position() : 0;
  if (left < io.count()) io.end_after(left);
  return static_cast<std::size_t>(std::min<std::uint64_t>(left, io.count()));
}

std::int64_t whole(const Parameters& p, const char* name, std::int64_t lowest, std::int64_t highest) {
  const std::int64_t value = p.integer(name);
  if (value < lowest || value > highest) {
    fail(std::string(name) + " is " + std::to_string(value) + ", allowed: " + std::to_string(lowest) + " to " +
         std::to_string(highest));
  }
  return value;
}

}  // namespace bodeflow::generators
