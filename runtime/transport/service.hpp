#pragma once

#include <bodeflow/transport.h>

#include <map>
#include <memory>
#include <mutex>

#include "transport/link.hpp"

namespace bodeflow::transport {

/// The host's side of "bodeflow.transport/1": topics for blocks, over one participant a DDS domain, which joins at its first use.
/// Lives as long as the blocks.
class Service {
 public:
  /// `settings` but for the domain, which topics name. `go_on` false ends calls that wait.
  explicit Service(Settings settings, GoOn go_on = {});
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  const bf_transport& c() const { return c_; }

 private:
  friend struct ServiceFunctions;
  tl::expected<std::shared_ptr<Participant>, std::string> participant(std::uint32_t domain);

  Settings settings_;
  GoOn go_on_;
  bf_transport c_{};
  std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<Participant>> participants_;
};

}  // namespace bodeflow::transport
