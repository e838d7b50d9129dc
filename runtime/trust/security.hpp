#pragma once

#include <optional>

#include "transport/settings.hpp"
#include "trust/certificate.hpp"

namespace bodeflow::trust {

/// The files with which a host joins the lab's network, checked; nothing where the folder does not exist or is empty. Fast DDS
/// says little of what is wrong with them, so every reason for which it would refuse is looked for here.
///
/// Error: a file is missing or can't be read; the key can be read by others, or is not the certificate's; the certificate is
/// expired, not valid yet, revoked, another host's, or of another authority than authority.pem; a document or the list of
/// revoked certificates is not signed by that authority.
Expected<std::optional<transport::Security>> security_of(const std::filesystem::path& folder, const std::string& host,
                                                         Time now = std::chrono::system_clock::now());

}  // namespace bodeflow::trust
