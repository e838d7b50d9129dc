#include "trust/certificate.hpp"

#include <fmt/format.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <array>
#include <ctime>
#include <vector>

namespace bodeflow::trust {
namespace {

using Number = std::unique_ptr<BIGNUM, Freed<BN_free>>;
using Integer = std::unique_ptr<ASN1_INTEGER, Freed<ASN1_INTEGER_free>>;
using Asn1Time = std::unique_ptr<ASN1_TIME, Freed<ASN1_TIME_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Freed<X509_EXTENSION_free>>;
using Revoked = std::unique_ptr<X509_REVOKED, Freed<X509_REVOKED_free>>;

constexpr int kSerialBits = 159;  // RFC 5280: at most 20 octets and positive; random, so that no file has to count

struct ExtensionText {
  int nid;
  const char* value;
};

bool add_name(X509_NAME* name, const char* field, const std::string& value) {
  return X509_NAME_add_entry_by_txt(name, field, MBSTRING_ASC, reinterpret_cast<const unsigned char*>(value.data()),
                                    static_cast<int>(value.size()), -1, 0) == 1;
}

bool add_extensions(X509& certificate, X509& issuer, const std::vector<ExtensionText>& extensions) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
  for (const ExtensionText& extension : extensions) {
    const Extension made(X509V3_EXT_nconf_nid(nullptr, &context, extension.nid, extension.value));
    if (!made || X509_add_ext(&certificate, made.get(), -1) != 1) return false;
  }
  return true;
}

bool set_time(ASN1_TIME* at, Time time) { return ASN1_TIME_set(at, std::chrono::system_clock::to_time_t(time)) != nullptr; }

bool set_serial(X509& certificate) {
  const Number serial(BN_new());
  return serial && BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(&certificate)) != nullptr;
}

/// All but extensions and signature. Names from the largest to the smallest, so that RFC 2253 gives "CN=...,O=...".
Certificate begun(EVP_PKEY& key, const std::string& lab, const std::string& name, Time now, Time until) {
  Certificate certificate(X509_new());
  const bool right = certificate && X509_set_version(certificate.get(), X509_VERSION_3) == 1 && set_serial(*certificate) &&
                     set_time(X509_getm_notBefore(certificate.get()), now - kBackdated) &&
                     set_time(X509_getm_notAfter(certificate.get()), until) && X509_set_pubkey(certificate.get(), &key) == 1 &&
                     add_name(X509_get_subject_name(certificate.get()), "O", lab) &&
                     add_name(X509_get_subject_name(certificate.get()), "CN", name);
  return right ? std::move(certificate) : Certificate();
}

Time time_of(const ASN1_TIME* time) {
  std::tm parts{};
  ASN1_TIME_to_tm(time, &parts);
  return std::chrono::system_clock::from_time_t(::timegm(&parts));
}

bool add_revoked(X509_CRL& list, X509& certificate, Time now) {
  Revoked entry(X509_REVOKED_new());
  const Asn1Time date(ASN1_TIME_new());
  if (!entry || !date || !set_time(date.get(), now) || X509_REVOKED_set_revocationDate(entry.get(), date.get()) != 1 ||
      X509_REVOKED_set_serialNumber(entry.get(), X509_get_serialNumber(&certificate)) != 1 ||
      X509_CRL_add0_revoked(&list, entry.get()) != 1)
    return false;
  entry.release();  // the list has it now
  return true;
}

bool copy_revoked(X509_CRL& list, X509_CRL& previous) {
  STACK_OF(X509_REVOKED)* entries = X509_CRL_get_REVOKED(&previous);
  for (int k = 0; k < sk_X509_REVOKED_num(entries); ++k) {
    Revoked entry(X509_REVOKED_dup(sk_X509_REVOKED_value(entries, k)));
    if (!entry || X509_CRL_add0_revoked(&list, entry.get()) != 1) return false;
    entry.release();
  }
  return true;
}

/// The authority's key identifier, which finds the right authority among those of equal name; and the list's number.
bool add_list_extensions(X509_CRL& list, X509& authority, long number) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &authority, nullptr, nullptr, &list, 0);
  const Extension identifier(X509V3_EXT_nconf_nid(nullptr, &context, NID_authority_key_identifier, "keyid:always"));
  const Integer value(ASN1_INTEGER_new());
  return identifier && X509_CRL_add_ext(&list, identifier.get(), -1) == 1 && value &&
         ASN1_INTEGER_set(value.get(), number) == 1 && X509_CRL_add1_ext_i2d(&list, NID_crl_number, value.get(), 0, 0) == 1;
}

bool fill(X509_CRL& list, X509_CRL* previous, X509* revoked, X509& authority, Time now) {
  const Asn1Time from(ASN1_TIME_new());
  return from && set_time(from.get(), now - kBackdated) && X509_CRL_set_version(&list, X509_CRL_VERSION_2) == 1 &&
         X509_CRL_set_issuer_name(&list, X509_get_subject_name(&authority)) == 1 &&
         X509_CRL_set1_lastUpdate(&list, from.get()) == 1 &&
         X509_CRL_set1_nextUpdate(&list, X509_get0_notAfter(&authority)) == 1 &&
         (previous == nullptr || copy_revoked(list, *previous)) && (revoked == nullptr || add_revoked(list, *revoked, now)) &&
         add_list_extensions(list, authority, previous == nullptr ? 1 : number(*previous) + 1) && X509_CRL_sort(&list) == 1;
}

}  // namespace

Expected<Key> make_key() {
  Key key(EVP_EC_gen("P-256"));
  if (!key) return tl::unexpected(openssl_failure("no key could be made"));
  return key;
}

Expected<Certificate> make_authority(EVP_PKEY& key, const std::string& lab, Time now, Time until) {
  Certificate certificate = begun(key, lab, "bodeflow authority", now, until);
  if (!certificate || X509_set_issuer_name(certificate.get(), X509_get_subject_name(certificate.get())) != 1 ||
      !add_extensions(*certificate, *certificate,
                      {{NID_basic_constraints, "critical,CA:TRUE,pathlen:0"},
                       {NID_key_usage, "critical,keyCertSign,cRLSign,digitalSignature"},
                       {NID_subject_key_identifier, "hash"}}) ||
      X509_sign(certificate.get(), &key, EVP_sha256()) <= 0)
    return tl::unexpected(openssl_failure("the authority's certificate could not be made"));
  return certificate;
}

Expected<Certificate> make_host(EVP_PKEY& key, const std::string& host, X509& authority, EVP_PKEY& authority_key, Time now,
                                Time until) {
  Certificate certificate = begun(key, subject_part(authority, NID_organizationName), host, now, until);
  if (!certificate || X509_set_issuer_name(certificate.get(), X509_get_subject_name(&authority)) != 1 ||
      !add_extensions(*certificate, authority,
                      {{NID_basic_constraints, "critical,CA:FALSE"},
                       {NID_key_usage, "critical,digitalSignature,keyAgreement"},
                       {NID_ext_key_usage, "critical,clientAuth,serverAuth"},
                       {NID_subject_key_identifier, "hash"},
                       {NID_authority_key_identifier, "keyid:always"}}) ||
      X509_sign(certificate.get(), &authority_key, EVP_sha256()) <= 0)
    return tl::unexpected(openssl_failure("the certificate of '" + host + "' could not be made"));
  return certificate;
}

Expected<RevocationList> make_revocations(X509_CRL* previous, X509* revoked, X509& authority, EVP_PKEY& authority_key, Time now) {
  RevocationList list(X509_CRL_new());
  if (!list || !fill(*list, previous, revoked, authority, now) || X509_CRL_sign(list.get(), &authority_key, EVP_sha256()) <= 0)
    return tl::unexpected(openssl_failure("the list of revoked certificates could not be made"));
  return list;
}

std::string pem(X509& certificate) {
  const Bio bio = memory();
  PEM_write_bio_X509(bio.get(), &certificate);
  return text_of(*bio);
}

std::string pem(X509_CRL& revocations) {
  const Bio bio = memory();
  PEM_write_bio_X509_CRL(bio.get(), &revocations);
  return text_of(*bio);
}

std::string pem(EVP_PKEY& key) {
  const Bio bio = memory();
  PEM_write_bio_PKCS8PrivateKey(bio.get(), &key, nullptr, nullptr, 0, nullptr, nullptr);
  return text_of(*bio);
}

Expected<Certificate> read_certificate(const std::string& pem) {
  Certificate certificate(PEM_read_bio_X509(reading(pem).get(), nullptr, nullptr, nullptr));
  if (!certificate) return tl::unexpected(openssl_failure("it is no certificate in PEM"));
  return certificate;
}

Expected<RevocationList> read_revocations(const std::string& pem) {
  RevocationList list(PEM_read_bio_X509_CRL(reading(pem).get(), nullptr, nullptr, nullptr));
  if (!list) return tl::unexpected(openssl_failure("it is no list of revoked certificates in PEM"));
  return list;
}

Expected<Key> read_key(const std::string& pem) {
  char no_password[] = "";  // never ask on the terminal
  Key key(PEM_read_bio_PrivateKey(reading(pem).get(), nullptr, nullptr, no_password));
  if (!key) return tl::unexpected(openssl_failure("it is no private key in PEM, or it has a password"));
  return key;
}

std::string subject_part(const X509& certificate, int nid) {
  std::array<char, 256> text{};
  const int size = X509_NAME_get_text_by_NID(X509_get_subject_name(&certificate), nid, text.data(), text.size());
  return size > 0 ? std::string(text.data()) : std::string();
}

std::string fingerprint(const X509& certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  X509_digest(&certificate, EVP_sha256(), digest.data(), &size);
  std::string text;
  for (unsigned int k = 0; k < size; ++k) text += fmt::format("{}{:02X}", k == 0 ? "" : ":", digest[k]);
  return text;
}

Time valid_from(const X509& certificate) { return time_of(X509_get0_notBefore(&certificate)); }
Time valid_until(const X509& certificate) { return time_of(X509_get0_notAfter(&certificate)); }

Time valid_from(const X509_CRL& revocations) { return time_of(X509_CRL_get0_lastUpdate(&revocations)); }

bool is_revoked(X509& certificate, X509_CRL& revocations) {
  X509_REVOKED* entry = nullptr;
  return X509_CRL_get0_by_cert(&revocations, &entry, &certificate) == 1;
}

long number(const X509_CRL& revocations) {
  const Integer value(static_cast<ASN1_INTEGER*>(X509_CRL_get_ext_d2i(&revocations, NID_crl_number, nullptr, nullptr)));
  return value ? ASN1_INTEGER_get(value.get()) : 0;
}

std::string utc_text(Time time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday, parts.tm_hour,
                     parts.tm_min, parts.tm_sec);
}

}  // namespace bodeflow::trust
