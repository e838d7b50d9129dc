#pragma once

#include <bodeflow/record.hpp>

#include "change.hpp"

namespace bodeflow::validation {

/// The record `change`. E entries, L lines, B bands, M modes of all entries together.
///
/// Attributes: `verdict`, `conclusion`, `scatter`, `scatter_known`, `variance_known`, `confidence`, `relevant`, `warnings`;
/// `entries`, `entry_verdicts`, `units`, `dl_911` (E, the degree of deformation or ""); `band_verdicts` (E x B row by row);
/// `mode_status` (M). Arrays: `frequency` [Hz] (L); `before`, `after`, `change_deviation`, `significance` (L x E);
/// `band_low`, `band_high` [Hz] (B); `band_change`, `band_probability`, `band_detectable`, `band_correlation`, `band_factor`,
/// `band_strongest` [Hz] (E x B); `correlation`, `factor` (E); `dl_911_factors` (E x 3); `orders`, `fit` (E x 2, before and
/// after); `mode_entry`, `mode_probability`, `mode_frequency_before`, `mode_frequency_after` [Hz], `mode_damping_before`,
/// `mode_damping_after`, each with `_deviation`, `mode_frequency_shift`, `mode_damping_shift` with `_deviation`,
/// `mode_inertia_ratio` (f before / f after)^2, the factor of the mass that moves where the stiffness has not changed (M). What
/// is not known is NaN.
RecordBuilder write_change(const ResponseChange& change, const ChangeSettings& settings);

}  // namespace bodeflow::validation
