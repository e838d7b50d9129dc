#pragma once

#include <array>

#include "transport/link.hpp"
#include "transport/middleware.hpp"

namespace bodeflow::transport {

/// Ways between two processes. A DDS participant uses one size of datagram for all that it sends, so shared memory has its own.
enum Way : std::size_t { kFar, kNear, kWays };

class Participant {
 public:
  Participant(std::shared_ptr<middleware::Node> far, std::shared_ptr<middleware::Node> near)
      : nodes_{std::move(far), std::move(near)} {}

  /// Null: there is no such way. kFar is always there.
  middleware::Node* node(Way way) const { return nodes_[way].get(); }

 private:
  std::array<std::shared_ptr<middleware::Node>, kWays> nodes_;
};

/// The topic of an edge on one way: on the near one a name of its own, so that other programs do not get messages twice.
inline std::string topic_on(Way way, const std::string& topic) { return way == kNear ? topic + ".near" : topic; }

/// Edges that other programs or late readers share use the far way only.
inline bool has_near(const Participant& participant, const Edge& edge) {
  return participant.node(kNear) != nullptr && edge.lossless && !edge.keeps_last && !edge.open;
}

}  // namespace bodeflow::transport
