#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/linear_system.hpp>

namespace bodeflow::plants {

/// Describes the parameters of a linear model: numerator and denominator; zeros, poles and gain; or a, b, c and d; and domain.
void describe_model(Describe& d);

/// The model that the graph gives in one of the three forms, as a state space; its sample_time is 0 for a continuous-time model,
/// 1 for a discrete-time one, whose samples are the stream's. Fails with the reason.
numerics::StateSpace read_model(const Parameters& p);

/// True if the model is given by its matrices, whose states mean something to the user.
bool given_by_matrices(const Parameters& p);

/// The value, or the end of the call in progress with the reason.
template <class T>
T value_or_fail(numerics::Expected<T> expected) {
  if (!expected) fail(expected.error().text);
  return std::move(*expected);
}

}  // namespace bodeflow::plants
