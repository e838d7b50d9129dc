#pragma once

#include <bodeflow/block.hpp>

#include "designer.hpp"
#include "estimator_bank.hpp"

/// Parameters that several blocks of this family share.
namespace bodeflow::adaptive_control {

/// Gives the value, or ends the block with the reason.
template <class T>
T value_or_fail(Expected<T> value) {
  if (!value) fail(value.error().text);
  return std::move(*value);
}

void describe_frequencies(Describe& d);

/// desired: {..} and observer: {..}.
void describe_desired(Describe& d);
/// The demands; `degree` is the order of the observer where none is given.
DesiredResponse read_desired(const Parameters& p, int degree);

/// degree, degree_s, fixed_r, fixed_s, weights.
void describe_structure(Describe& d);
RstStructure read_structure(const Parameters& p);

/// plant: {..} of a known plant; `read_plant` needs numerator and denominator.
void describe_plant(Describe& d, bool required);
bool has_plant(const Parameters& p);
numerics::TransferFunction read_plant(const Parameters& p);

Eigen::VectorXd vector_of(const std::vector<double>& values);

/// Ends the block where a value of the span is not finite.
void require_finite(std::span<const double> values, const char* port, std::uint64_t position);

/// The record `net_action` of an event. `omega`: frequencies of fitting, for the band's name.
RecordBuilder record_of(const NetEvent& event, const std::vector<double>& omega);

}  // namespace bodeflow::adaptive_control
