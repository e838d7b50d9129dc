#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "transport/link.hpp"

namespace bodeflow::lab {

/// How far another machine's wall clock is from ours: theirs minus ours, right to within the uncertainty.
struct ClockOffset {
  double offset_s = 0.0;
  double uncertainty_s = 0.0;  ///< half of the shortest round trip
};

/// Asks 16 times over a connection named `topic`, whose other end runs answer_clock; the shortest round trip counts (Cristian
/// 1989).
tl::expected<ClockOffset, std::string> ask_clock(const std::shared_ptr<transport::Participant>& participant,
                                                 const std::string& topic, double seconds);

/// Answers what ask_clock asks, for at most `seconds`.
void answer_clock(const std::shared_ptr<transport::Participant>& participant, const std::string& topic, double seconds);

}  // namespace bodeflow::lab
