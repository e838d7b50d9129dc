#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "change_spectrum.hpp"
#include "modes.hpp"

namespace bodeflow::validation {

/// Which of two lists belong to each other: entries of `pairs` have the place in the first list, in the second, or -1.
///
/// Method: the alignment of both lists by frequency with the least sum of |p - p'| / sqrt(|p p'|) over the pairs and half of
/// `apart` for each that stays alone (dynamic programming). Modes do not cross; further than `apart` from each other none are
/// paired.
std::vector<std::pair<int, int>> pair_modes(const std::vector<Mode>& before, const std::vector<Mode>& after, double apart);

enum class ModeStatus { same, moved, fresh, vanished, undecided };

/// "same", "moved", "new", "vanished", "undecided".
std::string status_text(ModeStatus status);

/// A mode before, after, or both.
struct ModeChange {
  std::optional<Mode> before, after;
  ModeStatus status = ModeStatus::undecided;
  double probability = 1.0;  ///< of as much change at the lines around it where nothing has changed; NaN: not known
  double frequency_shift = 0.0, frequency_shift_deviation = 0.0;  ///< after over before, less 1; NaN without both
  double damping_shift = 0.0, damping_shift_deviation = 0.0;      ///< after less before
};

/// What has become of each mode.
///
/// A pair has moved where its poles differ significantly by the covariances of both and the response has changed around them; a
/// mode without partner is new or vanished where the response has changed around it. Otherwise a lone mode is undecided: one of
/// two models has a pole that the responses do not tell apart. confidence: of all modes together.
std::vector<ModeChange> mode_changes(const ChangeLines& lines, const SpectrumChange& spectrum, const std::vector<Mode>& before,
                                     const std::vector<Mode>& after, double apart, double confidence);

}  // namespace bodeflow::validation
