#include "report/pole_zero.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/curve.hpp"
#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr double kChiSquare95 = 5.991464547107979;  ///< of two degrees of freedom: -2 ln 0.05
constexpr int kEllipsePoints = 48;
constexpr std::size_t kMostRoots = 400;

/// The region's border in the plane of the roots; empty where the covariance is none.
std::vector<std::complex<double>> ellipse(const Root& root) {
  std::vector<std::complex<double>> border;
  if (!root.has_covariance) return border;
  // Cholesky factor of the covariance turns the unit circle into the ellipse
  const double a = std::sqrt(root.real_variance);
  const double b = a > 0.0 ? root.covariance / a : 0.0;
  const double c = std::sqrt(std::max(0.0, root.imaginary_variance - b * b));
  const double scale = std::sqrt(kChiSquare95);
  for (int n = 0; n < kEllipsePoints; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kEllipsePoints;
    const double u = scale * std::cos(angle), v = scale * std::sin(angle);
    border.emplace_back(root.value.real() + a * u, root.value.imag() + b * u + c * v);
  }
  return border;
}

/// The roots that are drawn: finite, and not so far out that the poles would shrink to a point.
std::vector<Root> drawn_roots(const Record& model, bool poles) {
  double outermost = 0.0;
  for (const auto& pole : roots_of(model, true))
    if (std::isfinite(std::abs(pole.value))) outermost = std::max(outermost, std::abs(pole.value));
  std::vector<Root> drawn;
  for (const auto& root : roots_of(model, poles)) {
    const double size = std::abs(root.value);
    if (std::isfinite(size) && drawn.size() < kMostRoots && (poles || outermost == 0.0 || size <= kFarZero * outermost))
      drawn.push_back(root);
  }
  return drawn;
}

void draw_ellipses(Markup& body, const Frame& frame, const std::vector<Root>& roots, int colour) {
  for (const auto& root : roots) {
    std::string d;
    for (const auto& point : ellipse(root))
      d += fmt::format("{}{} {}", d.empty() ? "M" : "L", coordinate(frame.px(point.real())), coordinate(frame.py(point.imag())));
    if (d.empty()) continue;
    body.single("path", {{"d", d + "Z"}, {"class", fmt::format("a{}", colour)}});
    body.single("path", {{"d", d + "Z"}, {"class", fmt::format("l{} thin", colour)}});
  }
}

void draw_cross(Markup& body, double x, double y, double size, const char* style) {
  draw_line(body, x - size, y - size, x + size, y + size, style);
  draw_line(body, x - size, y + size, x + size, y - size, style);
}

/// The border of stability: the imaginary axis, or the unit circle.
void draw_border(Markup& body, const Frame& frame, bool z_plane) {
  if (!z_plane) {
    draw_line(body, frame.px(0.0), frame.top, frame.px(0.0), frame.top + frame.height, "mark");
    return;
  }
  std::string d;
  for (int n = 0; n <= 96; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / 96;
    d += fmt::format("{}{} {}", d.empty() ? "M" : "L", coordinate(frame.px(std::cos(angle))),
                     coordinate(frame.py(std::sin(angle))));
  }
  body.single("path", {{"d", d}, {"class", "mark"}});
}

void draw_legend(Markup& body, double x, bool poles, bool zeros, bool regions) {
  if (poles) {
    draw_cross(body, x + 5.0, 12.0, 4.5, "l0");
    draw_text(body, x + 16.0, 16.0, "poles");
    x += 66.0;
  }
  if (zeros) {
    body.single("circle", {{"cx", x + 5.0}, {"cy", 12.0}, {"r", 4.5}, {"class", "r1"}});
    draw_text(body, x + 16.0, 16.0, "zeros");
    x += 66.0;
  }
  if (!regions) return;
  body.single("rect", {{"x", x}, {"y", 6.0}, {"width", 18.0}, {"height", 11.0}, {"class", "a0"}});
  draw_text(body, x + 25.0, 16.0, "95 % region");
}

struct Extents {
  Extent x, y;
  bool regions = false;

  void add(const std::vector<Root>& roots) {
    for (const auto& root : roots) {
      x.add(root.value.real());
      y.add(root.value.imag());
      for (const auto& point : ellipse(root)) {
        x.add(point.real());
        y.add(point.imag());
      }
      regions |= root.has_covariance;
    }
  }
};

}  // namespace

bool is_z_plane(const Record& model) {
  const Array* poles = model.array("poles");
  const bool radians = poles != nullptr && poles->unit.find("rad") != std::string::npos;
  return model.number("sample_time") > 0.0 && !radians;
}

std::optional<Picture> draw_pole_zero(const Record& model, double width) {
  const auto poles = drawn_roots(model, true), zeros = drawn_roots(model, false);
  if (poles.empty() && zeros.empty()) return {};
  const bool z_plane = is_z_plane(model);
  Extents extents;
  extents.add(poles);
  extents.add(zeros);
  extents.x.add(0.0);
  extents.y.add(0.0);
  if (z_plane)
    for (const double edge : {-1.05, 1.05}) {
      extents.x.add(edge);
      extents.y.add(edge);
    }
  const double room_x = 0.06 * (extents.x.high - extents.x.low), room_y = 0.06 * (extents.y.high - extents.y.low);
  const double height = width >= 900.0 ? 430.0 : 300.0;
  const Axis y = make_axis(Scale::linear, extents.y.low - room_y, extents.y.high + room_y, static_cast<int>(height / 50.0),
                           z_plane ? "Imaginary part" : "Imaginary part [rad/s]");
  const double left = 36.0 + 6.4 * static_cast<double>(y.label_length());
  double inner = width - left - 18.0;
  if (z_plane) inner = std::min(inner, height * (extents.x.high - extents.x.low) / (y.high - y.low) * 1.1);
  const Axis x = make_axis(Scale::linear, extents.x.low - room_x, extents.x.high + room_x, static_cast<int>(inner / 80.0),
                           z_plane ? "Real part" : "Real part [rad/s]");

  Picture picture{"Poles and zeros",
                  fmt::format("{} poles and {} zeros in the {} plane.", poles.size(), zeros.size(), z_plane ? "z" : "s"),
                  width,
                  0.0,
                  {}};
  const Frame frame{left, 30.0, inner, z_plane ? inner * (y.high - y.low) / (x.high - x.low) : height, &x, &y};
  draw_legend(picture.body, left, !poles.empty(), !zeros.empty(), extents.regions);
  draw_frame(picture.body, frame, true);
  draw_border(picture.body, frame, z_plane);
  draw_ellipses(picture.body, frame, poles, 0);
  draw_ellipses(picture.body, frame, zeros, 1);
  for (const auto& zero : zeros)
    picture.body.single("circle",
                        {{"cx", frame.px(zero.value.real())}, {"cy", frame.py(zero.value.imag())}, {"r", 4.5}, {"class", "r1"}});
  for (const auto& pole : poles) draw_cross(picture.body, frame.px(pole.value.real()), frame.py(pole.value.imag()), 4.5, "l0");
  draw_upright_text(picture.body, 13.0, frame.top + 0.5 * frame.height, y.title);
  draw_text(picture.body, left + 0.5 * inner, frame.top + frame.height + 36.0, x.title, Anchor::middle);
  picture.height = frame.top + frame.height + 44.0;
  return picture;
}

}  // namespace bodeflow::tools::report
