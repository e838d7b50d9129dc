#pragma once

#include "report/model.hpp"
#include "report/page.hpp"
#include "report/response.hpp"

namespace bodeflow::tools::report {

/// Magnitude [dB] and phase [degrees] of one output / input with the bounds that the confidence circle gives them.
struct BodeCurve {
  Series magnitude;
  Series phase;
};

/// magnitude: 20 lg(|G| -+ r), the lower bound -infinity where the circle holds zero; phase: arg G -+ asin(r / |G|), a gap
/// there, because the phase is not known. Thinned to what a drawing can show.
BodeCurve bode_curve(const Response& response, std::size_t i, std::size_t j);

/// Bode plots, one an input with up to four outputs in it; with a model its response over the data.
std::vector<Chart> bode_charts(const Response& response, const Model* model);

/// "Magnitude [dB re 1 unit]", without the unit where those outputs have different ones.
std::string magnitude_title(const Response& response, std::size_t j, const std::vector<std::size_t>& outputs);

inline constexpr std::size_t kMostPairs = 36;  ///< outputs x inputs that are drawn; the rest stands in result.json

}  // namespace bodeflow::tools::report
