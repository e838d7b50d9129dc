#pragma once

#include <string>
#include <vector>

#include "report/markup.hpp"

namespace bodeflow::tools::report {

/// A drawing in its own coordinates, for the page and for a file.
struct Picture {
  std::string title;
  std::string description;  ///< for those who do not see it
  double width = 0.0;
  double height = 0.0;
  Markup body;
};

inline constexpr int kColours = 6;
inline constexpr double kTextSize = 12.0;

/// About how wide a text of the drawings' font is.
double text_width(std::string_view text, double size = kTextSize);

/// The picture as an <svg> element of a page that holds `figure_style`.
Markup inline_svg(const Picture& picture);

/// The picture as a file of its own: on white, with its title drawn above it.
std::string standalone_svg(const Picture& picture);

/// The style rules of drawings, for a light or a dark ground. Colours after Okabe & Ito (Color Universal Design, 2008), the light
/// ones darkened so far that a line has a contrast of 3 on white.
std::string figure_style(bool dark);

/// Where a text stands beside its point.
enum class Anchor { start, middle, end };

void draw_text(Markup& body, double x, double y, std::string_view text, Anchor anchor = Anchor::start, const char* style = "t");
/// The text turned by a quarter, reading upwards, centred at the point.
void draw_upright_text(Markup& body, double x, double y, std::string_view text);
void draw_line(Markup& body, double x1, double y1, double x2, double y2, const char* style);

/// A marker of the colour's own shape: circle, square, triangle, diamond, cross, ring.
void draw_marker(Markup& body, double x, double y, int colour, double size = 3.0);

}  // namespace bodeflow::tools::report
