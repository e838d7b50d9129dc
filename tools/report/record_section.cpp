#include <map>

#include "report/sections.hpp"

namespace bodeflow::tools::report {

std::string kind_of(const std::string& type) {
  static const std::map<std::string, std::string> kKinds{{"frequency_response", "frequency response"},
                                                         {"spectral_levels", "levels at all lines"},
                                                         {"spectral_matrix", "spectral matrix"},
                                                         {"model", "model"},
                                                         {"monte_carlo", "Monte Carlo"},
                                                         {"controller", "controller"},
                                                         {"adaptive_run", "adaptive run"},
                                                         {"trace", "residual trace"},
                                                         {"reveal", "verdict and truth"},
                                                         {"sweep", "sweep"},
                                                         {"comparison", "comparison of models"},
                                                         {"change", "change of a response"},
                                                         {"order_scan", "order scan"},
                                                         {"noise_variances", "noise variances"},
                                                         {"whiteness", "whiteness of the residual"},
                                                         {"residual", "residual"},
                                                         {"delay_estimate", "delay"}};
  const auto found = kKinds.find(type);
  return found == kKinds.end() ? type : found->second;
}

namespace {

bool add_by_type(Page& page, const Record& record, std::span<const Response> responses) {
  if (record.type == "frequency_response") return add_frequency_response(page, record);
  if (record.type == "spectral_levels") return add_spectral_levels(page, record);
  if (record.type == "spectral_matrix") return add_spectral_matrix(page, record);
  if (record.type == "model") return add_model(page, record, responses);
  if (record.type == "parameters") return add_derived_parameters(page, record);
  if (record.type == "monte_carlo") return add_monte_carlo(page, record);
  if (record.type == "noise_variances") return add_noise_variances(page, record);
  if (record.type == "comparison") return add_comparison(page, record);
  if (record.type == "change") return add_change(page, record);
  if (record.type == "order_scan") return add_order_scan(page, record);
  if (record.type == "whiteness") return add_whiteness(page, record);
  if (record.type == "residual") return add_residual(page, record) || add_fitted_lines(page, record);
  if (record.type == "controller") return add_controller(page, record);
  if (record.type == "adaptive_run") return add_adaptive_run(page, record);
  if (record.type == "filter") return add_filter(page, record);
  if (record.type == "trace") return add_trace(page, record);
  if (record.type == "reveal") return add_reveal(page, record);
  if (record.type == "sweep") return add_sweep(page, record);
  if (record.type == "delay_estimate") return add_delay_estimate(page, record), true;
  return false;
}

}  // namespace

void add_record(Page& page, const Record& record, std::span<const Response> responses) {
  if (!add_by_type(page, record, responses)) add_any(page, record);
}

}  // namespace bodeflow::tools::report
