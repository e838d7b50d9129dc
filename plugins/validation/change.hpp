#pragma once

#include <bodeflow/error.hpp>
#include <optional>
#include <string>
#include <vector>

#include "change_lines.hpp"
#include "change_spectrum.hpp"
#include "magnitude_factors.hpp"
#include "mode_pairs.hpp"
#include "modes.hpp"
#include "records/response.hpp"

namespace bodeflow::validation {

struct ChangeSettings {
  SpectrumSettings spectrum;
  ModeSettings modes;
  bool find_modes = true;
  double apart = 0.1;  ///< largest distance of two poles that are paired, over their size
};

/// What has become of one entry of the response.
struct EntryChange {
  std::string name, unit;
  ChangeLines lines;
  SpectrumChange spectrum;
  StandardFactors standard;
  double correlation = 0.0, factor = 0.0;  ///< of all lines
  std::optional<FittedModes> before, after;
  std::string no_modes;  ///< why there are none
  std::vector<ModeChange> modes;
};

/// Two responses of the same plant, and what has changed between them.
struct ResponseChange {
  std::vector<EntryChange> entries;
  Eigen::Index interpolated = 0, left_out = 0;  ///< lines
  std::string scatter;                          ///< "unknown", or where it comes from
  bool scatter_known = false, variance_known = false;
  Verdict verdict = Verdict::undecidable;
  std::string conclusion;  ///< a sentence for people
  std::vector<std::string> warnings;
};

/// Whether, where and how a plant has changed from one response to the other: bands by their significance, resonances of models
/// fitted to both, factors that are in use for transformer windings.
///
/// Each entry of a matrix of responses is judged by itself, the level of significance is shared by all. Errors: those of align,
/// spectrum_change. Where no model can be fitted the modes are left out, and `no_modes` says why.
/// Source: the purpose of H. Akcay, S. M. Islam, B. Ninness, Subspace based identification of power transformer models from
/// frequency response data, 1998.
Expected<ResponseChange> response_change(const records::ResponseData& before, const records::ResponseData& after,
                                         const Scatter& scatter, const ChangeSettings& settings);

}  // namespace bodeflow::validation
