#include "report/picture.hpp"

#include <fmt/format.h>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr double kTitleHeight = 30.0;
constexpr const char* kFont = "system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue','Noto Sans','DejaVu Sans',sans-serif";

struct Palette {
  const char* ink;    ///< texts
  const char* quiet;  ///< labels
  const char* frame;  ///< frames of panels
  const char* grid;
  const char* minor;
  const char* ground;
  const char* series[kColours];
};

constexpr Palette kLight{"#1a1d21",
                         "#4a5058",
                         "#8a9099",
                         "#d9dde2",
                         "#eceff2",
                         "#ffffff",
                         {"#0072b2", "#d55e00", "#00795a", "#b8578f", "#9a6a00", "#3d4650"}};
constexpr Palette kDark{"#e8eaed",
                        "#b4bac2",
                        "#6d747d",
                        "#363c44",
                        "#272c33",
                        "#15181c",
                        {"#56b4e9", "#ff8a3d", "#2fc79b", "#e69ac6", "#f0d442", "#c3cad3"}};

constexpr const char* kDashes[kColours] = {"", "8 3", "2.5 2.5", "9 3 2.5 3", "5 2", "1.5 4"};

void add_description(Markup& svg, const Picture& picture) {
  svg.element("title", picture.title);
  if (!picture.description.empty()) svg.element("desc", picture.description);
}

std::string view_box(double width, double height) { return "0 0 " + coordinate(width) + " " + coordinate(height); }

}  // namespace

double text_width(std::string_view text, double size) { return 0.58 * size * static_cast<double>(length_of(text)); }

Markup inline_svg(const Picture& picture) {
  Markup svg;
  svg.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                   {"class", "fig"},
                   {"viewBox", view_box(picture.width, picture.height)},
                   {"width", picture.width},
                   {"height", picture.height},
                   {"role", "img"}});
  add_description(svg, picture);
  return svg.add(picture.body).close("svg");
}

std::string standalone_svg(const Picture& picture) {
  const double height = picture.height + kTitleHeight;
  Markup svg;
  svg.trusted("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  svg.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                   {"class", "fig"},
                   {"viewBox", view_box(picture.width, height)},
                   {"width", picture.width},
                   {"height", height},
                   {"role", "img"}});
  add_description(svg, picture);
  svg.open("style").trusted(figure_style(false)).close("style");
  svg.single("rect", {{"width", picture.width}, {"height", height}, {"fill", kLight.ground}});
  const auto most = static_cast<std::size_t>(picture.width / text_width("m", 14.0));
  draw_text(svg, 10.0, 20.0, shortened(picture.title, most), Anchor::start, "h");
  svg.open("g", {{"transform", fmt::format("translate(0 {})", kTitleHeight)}}).add(picture.body).close("g");
  return svg.close("svg").trusted("\n").str();
}

std::string figure_style(bool dark) {
  const Palette& palette = dark ? kDark : kLight;
  std::string css = fmt::format(
      ".fig text{{font:{}px {};font-variant-numeric:tabular-nums;fill:{}}}"
      ".fig .q{{fill:{};font-size:11px}}.fig .h{{font-size:14px;font-weight:600}}.fig .b{{font-weight:600}}"
      ".fig .frame{{fill:none;stroke:{};stroke-width:1}}"
      ".fig .grid{{stroke:{};stroke-width:1}}.fig .minor{{stroke:{};stroke-width:1}}"
      ".fig .mark{{stroke:{};stroke-width:1.2;stroke-dasharray:4 3;fill:none}}"
      ".fig .box{{fill:{};stroke:{};stroke-width:1.2}}.fig .wire{{fill:none;stroke:{};stroke-width:1.4}}"
      ".fig .arrow{{fill:{}}}.fig .group{{fill:none;stroke:{};stroke-dasharray:2 3}}"
      ".fig .records{{stroke-dasharray:5 3}}",
      kTextSize, kFont, palette.ink, palette.quiet, palette.frame, palette.grid, palette.minor, palette.quiet, palette.ground,
      palette.quiet, palette.quiet, palette.quiet, palette.frame);
  for (int i = 0; i < kColours; ++i) {
    css += fmt::format(".fig .l{0}{{fill:none;stroke:{1};stroke-width:1.6;stroke-linejoin:round}}", i, palette.series[i]);
    css += fmt::format(".fig .a{0}{{fill:{1};fill-opacity:{2};stroke:none}}", i, palette.series[i], dark ? 0.32 : 0.24);
    css += fmt::format(".fig .m{0}{{fill:{1};stroke:none}}.fig .r{0}{{fill:none;stroke:{1};stroke-width:1.4}}", i,
                       palette.series[i]);
    if (*kDashes[i] != '\0') css += fmt::format(".fig .d{}{{stroke-dasharray:{}}}", i, kDashes[i]);
  }
  return css + fmt::format(".fig .halo{{paint-order:stroke;stroke:{};stroke-width:3px;stroke-linejoin:round}}", palette.ground) +
         ".fig .thin{stroke-width:1}.fig .model{stroke-width:2}";
}

void draw_text(Markup& body, double x, double y, std::string_view text, Anchor anchor, const char* style) {
  const char* where = anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
  body.element("text", {{"x", x}, {"y", y}, {"text-anchor", where}, {"class", style}}, text);
}

void draw_upright_text(Markup& body, double x, double y, std::string_view text) {
  const std::string turn = fmt::format("rotate(-90 {} {})", coordinate(x), coordinate(y));
  body.element("text", {{"x", x}, {"y", y}, {"text-anchor", "middle"}, {"class", "t"}, {"transform", turn}}, text);
}

void draw_line(Markup& body, double x1, double y1, double x2, double y2, const char* style) {
  body.single("line", {{"x1", x1}, {"y1", y1}, {"x2", x2}, {"y2", y2}, {"class", style}});
}

void draw_marker(Markup& body, double x, double y, int colour, double size) {
  const std::string filled = fmt::format("m{}", colour), open = fmt::format("r{}", colour);
  const auto path = [&](const std::string& style, std::initializer_list<std::pair<double, double>> points, bool closed) {
    std::string d;
    for (const auto& [dx, dy] : points)
      d += (d.empty() ? "M" : "L") + coordinate(x + dx * size) + " " + coordinate(y + dy * size);
    body.single("path", {{"d", d + (closed ? "Z" : "")}, {"class", style}});
  };
  switch (colour) {
    case 1:
      return path(filled, {{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}}, true);
    case 2:
      return path(filled, {{0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}}, true);
    case 3:
      return path(filled, {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}}, true);
    case 4:
      body.single("circle", {{"cx", x}, {"cy", y}, {"r", size}, {"class", open}});
      return;
    case 5:
      path(open, {{-1, -1}, {1, 1}}, false);
      return path(open, {{-1, 1}, {1, -1}}, false);
    default:
      body.single("circle", {{"cx", x}, {"cy", y}, {"r", size}, {"class", filled}});
  }
}

}  // namespace bodeflow::tools::report
