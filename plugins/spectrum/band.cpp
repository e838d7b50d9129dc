#include "band.hpp"

#include <algorithm>
#include <cmath>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

// A frequency within this part of a line's spacing of a line means that line: decimal numbers are not exact.
constexpr double kSameLine = 1e-6;

}  // namespace

Expected<LineRange> lines_in_band(const std::vector<double>& band_hz, double sample_rate_hz, std::int64_t samples) {
  const std::int64_t highest = (samples - 1) / 2;
  if (highest < 1) return unexpected(counted(samples, "sample") + " have no line between zero and the Nyquist frequency");
  if (band_hz.empty()) return LineRange{1, highest};
  if (band_hz.size() != 2)
    return unexpected("band has " + counted(static_cast<std::int64_t>(band_hz.size()), "value") + "; needed: [from, to]");
  const double from = band_hz[0], to = band_hz[1], spacing = sample_rate_hz / static_cast<double>(samples);
  const std::string text = "band [" + short_number(from) + " Hz, " + short_number(to) + " Hz]";
  if (!(from <= to)) return unexpected(text + " does not rise");
  if (!(to < sample_rate_hz / 2.0))
    return unexpected(text + " reaches the Nyquist frequency " + short_number(sample_rate_hz / 2.0) + " Hz");
  const LineRange lines{std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(from / spacing - kSameLine))),
                        std::min(highest, static_cast<std::int64_t>(std::floor(to / spacing + kSameLine)))};
  if (lines.first > lines.last)
    return unexpected(text + " holds no line; they are multiples of " + short_number(spacing) + " Hz");
  return lines;
}

}  // namespace bodeflow::spectrum
