#pragma once

#include <string>
#include <vector>

#include "trust/certificate.hpp"

namespace bodeflow::trust {

/// The rules of the lab, the same for all hosts (DDS-Security 1.1, section 9.4.1.2): nobody joins without a certificate and
/// permissions, in any domain; discovery and liveliness are encrypted; every topic needs permission, and samples are encrypted.
///
/// Samples are encrypted one by one because Fast DDS 2.9 checks nothing else of what it receives: it takes a plain sample in
/// the name of a known writer although the rules protect whole messages or submessages.
std::string governance_text();

/// What a host may do (section 9.4.1.3): publish and subscribe to the topics that match one of the patterns of fnmatch, in any
/// partition and domain; nothing else.
std::string permissions_text(const std::string& host, const std::string& lab, const std::vector<std::string>& topics, Time from,
                             Time until);
/// The patterns that permissions_text got.
std::vector<std::string> permitted_topics(const std::string& permissions_text);

/// The text, signed by the authority as S/MIME with the text in clear.
Expected<std::string> signed_text(const std::string& text, X509& authority, EVP_PKEY& authority_key);
/// The text that was signed. Error: it is not signed, was changed, or the signature is another's than the authority's, or the
/// authority's certificate is not valid at `now`.
Expected<std::string> verified_text(const std::string& signed_text, X509& authority, Time now);

}  // namespace bodeflow::trust
