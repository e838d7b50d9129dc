#pragma once

#include "report/chart.hpp"

namespace bodeflow::tools::report {

/// A panel's rectangle and axes in a drawing.
struct Frame {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
  const Axis* x = nullptr;
  const Axis* y = nullptr;

  double px(double value) const;  ///< not finite where the value has no place
  double py(double value) const;  ///< kept within the panel; NaN stays NaN
};

/// Grid, frame and the labels of the vertical axis; those of the horizontal one with `x_labels`.
void draw_frame(Markup& body, const Frame& frame, bool x_labels);

/// The band and the curve, with at most four points for each two units of width.
void draw_series(Markup& body, const Frame& frame, const Series& series);

/// A piece of the curve as it stands in the legend, from x on.
void draw_sample(Markup& body, double x, double y, const Series& series);

}  // namespace bodeflow::tools::report
