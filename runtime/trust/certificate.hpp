#pragma once

#include <chrono>
#include <string>

#include "trust/openssl.hpp"

namespace bodeflow::trust {

using Time = std::chrono::system_clock::time_point;

/// What is made today is valid from this much earlier on: clocks of machines in a lab differ, and the times in a permissions
/// document are read in the local time of whoever reads them.
inline constexpr std::chrono::hours kBackdated{24};

/// A new key on the curve P-256.
Expected<Key> make_key();

/// The certificate of a lab's authority, signed by its own key: it may sign certificates, lists of revoked ones and documents.
Expected<Certificate> make_authority(EVP_PKEY& key, const std::string& lab, Time now, Time until);

/// A host's certificate, signed by the authority. Its key may authenticate the host and nothing else: it signs no documents, so
/// that a host can't grant itself permissions.
Expected<Certificate> make_host(EVP_PKEY& key, const std::string& host, X509& authority, EVP_PKEY& authority_key, Time now,
                                Time until);

/// A list of revoked certificates, signed by the authority and valid as long as it. `previous` may be null; its entries are
/// kept, and `revoked`, which may be null, is added.
Expected<RevocationList> make_revocations(X509_CRL* previous, X509* revoked, X509& authority, EVP_PKEY& authority_key, Time now);

std::string pem(X509& certificate);
std::string pem(X509_CRL& revocations);
std::string pem(EVP_PKEY& key);  ///< PKCS #8, not encrypted
Expected<Certificate> read_certificate(const std::string& pem);
Expected<RevocationList> read_revocations(const std::string& pem);
Expected<Key> read_key(const std::string& pem);

/// A part of the subject: NID_commonName, NID_organizationName; "" where it has none.
std::string subject_part(const X509& certificate, int nid);
/// SHA-256 of the certificate as `openssl x509 -fingerprint -sha256` prints it: "AB:CD:...".
std::string fingerprint(const X509& certificate);
Time valid_from(const X509& certificate);
Time valid_until(const X509& certificate);
Time valid_from(const X509_CRL& revocations);
bool is_revoked(X509& certificate, X509_CRL& revocations);
/// The number of a list: a later one has a higher one.
long number(const X509_CRL& revocations);

/// "2026-11-22T22:00:00Z".
std::string utc_text(Time time);

}  // namespace bodeflow::trust
