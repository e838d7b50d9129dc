#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/axis.hpp"
#include "report/picture.hpp"

namespace bodeflow::tools::report {

/// A curve with an optional band. NaN is a gap; an infinite bound of the band is the edge of the panel.
struct Series {
  std::string name;  ///< in the legend; "" keeps it out
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> low;  ///< of the band, empty without one
  std::vector<double> high;
  int colour = 0;  ///< 0 .. kColours - 1; the dash and the marker follow it
  bool solid = false;
  bool line = true;
  bool markers = false;
  bool envelope = false;  ///< the band is the curve itself (least and greatest value), `y` is not drawn
  bool model = false;     ///< drawn over the data, thicker and dashed
};

/// A level with its name, drawn across the panel.
struct Level {
  double y = 0.0;
  std::string label;
};

struct Panel {
  Axis y;                 ///< filled in when drawn; `scale` and `title` are given
  double height = 200.0;  ///< of the wide drawing
  std::vector<Series> series;
  std::vector<Level> levels;
  std::optional<Extent> range;  ///< of the y axis; from the series otherwise
  bool absolute = false;        ///< of decibels: absolute values stand at the right
};

/// Panels above each other with one horizontal axis.
struct Chart {
  std::string name;  ///< of its file
  std::string title;
  std::string description;
  std::string x_title;
  bool x_logarithmic = false;
  std::vector<Panel> panels;
};

inline constexpr double kWide = 940.0;
inline constexpr double kNarrow = 360.0;
inline constexpr double kSmall = 410.0;

/// The chart `width` wide: kWide for a page, kNarrow for a telephone, kSmall for a grid of small charts.
Picture draw_chart(const Chart& chart, double width);

/// True where frequencies spread so far that a logarithmic axis tells more (from a factor of 4).
bool is_logarithmic(const std::vector<double>& frequency);

/// The lines of a curve that tell it at `bins` places: in each the first, the last, the least and the greatest.
/// Cost: one pass. Curves with at most 4 * bins points stay whole.
std::vector<std::size_t> telling_points(const Series& series, const Axis& x, std::size_t bins);

/// The series with only the lines that any drawing can show: for results of millions of lines.
Series thinned(const Series& series, bool logarithmic);

/// A number of markers that can still be told apart.
inline constexpr std::size_t kMostMarkers = 130;

}  // namespace bodeflow::tools::report
