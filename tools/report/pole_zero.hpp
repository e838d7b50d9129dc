#pragma once

#include <optional>

#include "report/model.hpp"
#include "report/picture.hpp"

namespace bodeflow::tools::report {

/// Poles (crosses) and zeros (rings) of a model with their 95 % confidence ellipses (two degrees of freedom, known covariance),
/// in the s plane [rad/s], or in the z plane with the unit circle. Nothing for a model without roots.
std::optional<Picture> draw_pole_zero(const Record& model, double width);

/// True where the model's roots are values of z.
bool is_z_plane(const Record& model);

/// Roots further out than this many times the outermost pole are left out of the drawing.
inline constexpr double kFarZero = 10.0;

}  // namespace bodeflow::tools::report
