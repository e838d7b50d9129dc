#include "hold_out_bands.hpp"

#include <algorithm>
#include <cmath>

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

Expected<HeldOutBands> hold_out_bands(const records::ResponseData& r, int bands, int every) {
  if (every < 2) return refused("every = " + std::to_string(every) + "; allowed: 2 and more");
  if (bands < 2) return refused("bands = " + std::to_string(bands) + "; allowed: 2 and more");
  const Eigen::Index lines = r.frequency_hz.size();
  Eigen::Index first = 0;
  while (first < lines && !(r.frequency_hz[first] > 0.0)) ++first;
  if (lines - first < 2) return refused("a response of " + std::to_string(lines) + " lines has no bands");
  const double start = std::log(r.frequency_hz[first]), width = std::log(r.frequency_hz[lines - 1]) - start;
  std::vector<Eigen::Index> kept, held_out;
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double place = k < first ? 0.0 : (std::log(r.frequency_hz[k]) - start) / width;
    const int band = std::min(static_cast<int>(place * bands), bands - 1);
    (k >= first && band % every == every / 2 ? held_out : kept).push_back(k);
  }
  if (held_out.empty() || kept.empty())
    return refused(std::to_string(bands) + " bands of which every " + std::to_string(every) +
                   "th is held out leave a part without lines");
  return HeldOutBands{lines_of(r, kept), lines_of(r, held_out)};
}

}  // namespace bodeflow::residual
