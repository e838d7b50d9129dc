#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "identification.hpp"
#include "records/signals.hpp"

namespace bodeflow::koopmans_levin {

/// Where the samples of a model came from.
struct Origin {
  double sample_rate_hz = 1.0;
  records::Signals input, output;  ///< one name and unit each
  double input_amplitude = 0.0;    ///< largest |u|
  std::string checksum;
  std::vector<std::string> warnings;
};

/// The record `model`. Beside what records/model.hpp writes: attributes `ratio_determined`, `ratio_source`, `noise_ratio_std`,
/// `input_noise_variance_std`, `smallest_eigenvalue` (lambda_u as the method gives it, not corrected for the parameters fitted),
/// `whiteness_probability`; arrays `pole_frequency`, `pole_frequency_std` [Hz], `pole_damping_ratio`, `transient` (tau),
/// `ratio_shift_in_std` (what a factor 2 in the ratio moves each parameter by). Poles and zeros ascend in frequency, of each pair
/// the one above the axis first. Errors: those of the roots.
Expected<RecordBuilder> model_record(const Identification& found, const Origin& from);

/// The record `order_scan`: arrays `order`, `noise_variance`, `eigenvalue_ratio`; attributes `chosen` (0: none), `tolerance`.
RecordBuilder order_scan_record(const OrderScan& scan);

/// The record `whiteness`: arrays `frequency` [Hz] and `power` (1 as expected) of the bands; attributes `statistic`,
/// `degrees_of_freedom`, `probability`.
RecordBuilder whiteness_record(const Whiteness& test, double sample_rate_hz);

}  // namespace bodeflow::koopmans_levin
