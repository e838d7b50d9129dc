#pragma once

#include <string>

namespace bodeflow::lab {

/// Where agents show themselves.
inline constexpr const char* kAgentsBoard = "bodeflow/agents";

/// Where an agent takes requests.
inline std::string mailbox_of(const std::string& agent) { return "bodeflow/agent/" + agent; }

/// Where a question for an agent's time is answered.
inline std::string clock_topic(const std::string& name) { return "bodeflow/clock/" + name; }

}  // namespace bodeflow::lab
