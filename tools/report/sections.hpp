#pragma once

#include <span>

#include "report/page.hpp"
#include "report/record.hpp"
#include "report/response.hpp"

// One function a record type: adds what the record tells to the page. False: the record lacks what its type promises, nothing was
// added; it is then shown as any record is.
namespace bodeflow::tools::report {

bool add_frequency_response(Page& page, const Record& record);
/// Of a frequency response its main figures and Bode plots alone.
bool add_bode_plots(Page& page, const Record& record);
bool add_spectral_levels(Page& page, const Record& record);
bool add_spectral_matrix(Page& page, const Record& record);
/// `responses`: all of the run, for the comparison with data.
bool add_model(Page& page, const Record& record, std::span<const Response> responses);
bool add_derived_parameters(Page& page, const Record& record);
bool add_monte_carlo(Page& page, const Record& record);
/// Noise of input and output by band, and the curves of the Frisch scheme.
bool add_noise_variances(Page& page, const Record& record);
/// Fits, signals, correlations, parameters and responses of models side by side.
bool add_comparison(Page& page, const Record& record);
/// Whether a plant has changed between two responses: spectrum, bands, resonances.
bool add_change(Page& page, const Record& record);
bool add_order_scan(Page& page, const Record& record);
/// The power of a residual by bands.
bool add_whiteness(Page& page, const Record& record);
/// What a model leaves of a frequency response, by bands and line by line.
bool add_residual(Page& page, const Record& record);
/// The same of a record with data and model line by line: percentage error, and of a sum of bands D. A. Jue's six panels a band.
bool add_fitted_lines(Page& page, const Record& record);
bool add_controller(Page& page, const Record& record);
/// An adaptive run: signals, Nyquist curve with the estimates, controllers over time.
bool add_adaptive_run(Page& page, const Record& record);
/// Frequency and impulse response of a filter as it was configured.
bool add_filter(Page& page, const Record& record);
bool add_trace(Page& page, const Record& record);
bool add_reveal(Page& page, const Record& record);
bool add_sweep(Page& page, const Record& record);

/// What a type of records is called.
std::string kind_of(const std::string& type);

/// Any record, by its type; `responses`: those that a model may be compared with.
void add_record(Page& page, const Record& record, std::span<const Response> responses);

/// The responses of a sweep's runs over each other, where its records were frequency responses.
void add_sweep_charts(Page& page, const Record& record, std::size_t runs);

/// Any record: its attributes, its arrays as numbers or as curves.
void add_any(Page& page, const Record& record);

/// Says the delay first, then what any record says.
void add_delay_estimate(Page& page, const Record& record);

/// The attributes that have not been shown elsewhere.
Facts facts_of(const Record& record, const std::vector<std::string>& shown_elsewhere);
void add_attributes(Page& page, const Record& record, const std::vector<std::string>& shown_elsewhere);

/// One-dimensional arrays (of that length, unless it is 0) as small charts over frequency, time or index.
void add_curves(Page& page, const Record& record, const std::vector<std::string>& shown_elsewhere, std::size_t length);

}  // namespace bodeflow::tools::report
