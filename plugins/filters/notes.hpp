#pragma once

#include <bodeflow/facts.hpp>

namespace bodeflow::filters {

using Notes = std::map<std::string, std::vector<double>>;

/// Notes of a stream multiplied by `factor`: amplitudes and noise follow.
Notes scaled(Notes notes, double factor);

/// Notes of the sum of two streams: independent noises add in power; what only one of them states holds, what both state (an
/// excitation of two periods) holds where they agree.
Notes added(const Notes& a, const Notes& b);

/// Notes of a stream behind a filter that changes amplitudes and colours noise: the times and lines of the excitation stay, what
/// is known of the plant too, with at least that settling time.
Notes filtered(const Notes& notes, double settling_s);

}  // namespace bodeflow::filters
