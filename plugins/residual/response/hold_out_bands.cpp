#include "hold_out_bands.hpp"

#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

records::ResponseData lines_of(const records::ResponseData& all, const std::vector<Eigen::Index>& rows) {
  records::ResponseData part = all;
  part.frequency_hz = all.frequency_hz(rows);
  part.response = all.response(rows, Eigen::all);
  if (all.variance.size() != 0) part.variance = all.variance(rows, Eigen::all);
  if (all.confidence_radius.size() != 0) part.confidence_radius = all.confidence_radius(rows, Eigen::all);
  part.lines.clear();
  if (!all.lines.empty())
    for (const Eigen::Index k : rows) part.lines.push_back(all.lines[static_cast<std::size_t>(k)]);
  part.spectra.reset();
  return part;
}

}  // namespace

Expected<HeldOutBands> hold_out_bands(const records::ResponseData& r, double octaves, int every) {
  if (!(octaves > 0.0)) return refused("octaves = " + records::short_number(octaves) + "; allowed: above 0");
  if (every < 2) return refused("every = " + std::to_string(every) + "; allowed: 2 and more");
  double start = 0.0;
  std::vector<Eigen::Index> kept, held_out;
  for (Eigen::Index k = 0; k < r.frequency_hz.size(); ++k) {
    const double f = r.frequency_hz[k];
    if (!(start > 0.0)) start = f;
    const double band = f > 0.0 ? std::floor(std::log2(f / start) / octaves) : 0.0;
    (std::fmod(band, every) == static_cast<double>(every / 2) ? held_out : kept).push_back(k);  // NOLINT: whole numbers
  }
  if (held_out.empty() || kept.empty())
    return refused("its " + records::counted(r.frequency_hz.size(), "line") + " are too near to each other for bands of " +
                   records::short_number(octaves) + " octaves of which every " + std::to_string(every) + "th is held out");
  return HeldOutBands{lines_of(r, kept), lines_of(r, held_out)};
}

}  // namespace bodeflow::residual
