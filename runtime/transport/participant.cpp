#include "transport/participant.hpp"

#include "transport/leftovers.hpp"

namespace bodeflow::transport {

tl::expected<std::shared_ptr<Participant>, std::string> join(const Settings& settings) {
  using Carrier = Settings::Carrier;
  if (!(settings.lease_s >= 0.5 && settings.lease_s <= 3600.0)) {
    return tl::unexpected("lease of " + std::to_string(settings.lease_s) + " s (allowed: 0.5 to 3600)");
  }
  remove_leftovers();
  const bool automatic = settings.carrier == Carrier::automatic;
  auto far = middleware::join(settings, automatic ? Carrier::udp : settings.carrier);
  if (!far) return tl::unexpected(far.error());
  std::shared_ptr<middleware::Node> near;
  if (automatic) {
    // Without shared memory (a container with none, for example) UDP carries what is on the host too.
    if (auto joined = middleware::join(settings, Carrier::shared_memory)) near = *joined;
  }
  return std::make_shared<Participant>(*far, std::move(near));
}

}  // namespace bodeflow::transport
