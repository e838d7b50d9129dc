#include "trust/documents.hpp"

#include <fmt/format.h>

namespace bodeflow::trust {
namespace {

constexpr const char* kAllDomains = "<domains><id_range><min>0</min><max>232</max></id_range></domains>";

std::string topic_rule(const char* name, const std::vector<std::string>& topics) {
  std::string text = fmt::format("<{}>\n<topics>\n", name);
  for (const std::string& topic : topics) text += fmt::format("<topic>{}</topic>\n", topic);
  return text + fmt::format("</topics>\n<partitions><partition>*</partition></partitions>\n</{}>\n", name);
}

/// Without the fraction and the zone, which readers of these documents may not know.
std::string document_time(Time time) { return utc_text(time).substr(0, std::string("2026-11-22T22:00:00").size()); }

}  // namespace

std::string governance_text() {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds>
<domain_access_rules>
<domain_rule>
{}
<allow_unauthenticated_participants>false</allow_unauthenticated_participants>
<enable_join_access_control>true</enable_join_access_control>
<discovery_protection_kind>ENCRYPT</discovery_protection_kind>
<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
<rtps_protection_kind>NONE</rtps_protection_kind>
<topic_access_rules>
<topic_rule>
<topic_expression>*</topic_expression>
<enable_discovery_protection>true</enable_discovery_protection>
<enable_liveliness_protection>true</enable_liveliness_protection>
<enable_read_access_control>true</enable_read_access_control>
<enable_write_access_control>true</enable_write_access_control>
<metadata_protection_kind>NONE</metadata_protection_kind>
<data_protection_kind>ENCRYPT</data_protection_kind>
</topic_rule>
</topic_access_rules>
</domain_rule>
</domain_access_rules>
</dds>
)",
                     kAllDomains);
}

std::string permissions_text(const std::string& host, const std::string& lab, const std::vector<std::string>& topics, Time from,
                             Time until) {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds>
<permissions>
<grant name="{0}">
<subject_name>CN={0},O={1}</subject_name>
<validity>
<not_before>{2}</not_before>
<not_after>{3}</not_after>
</validity>
<allow_rule>
{4}
{5}{6}</allow_rule>
<default>DENY</default>
</grant>
</permissions>
</dds>
)",
                     host, lab, document_time(from), document_time(until), kAllDomains, topic_rule("publish", topics),
                     topic_rule("subscribe", topics));
}

std::vector<std::string> permitted_topics(const std::string& permissions_text) {
  const std::string open = "<topic>", close = "</topic>";
  std::vector<std::string> topics;
  const std::string publish = permissions_text.substr(0, permissions_text.find("</publish>"));
  for (std::size_t at = 0; (at = publish.find(open, at)) != std::string::npos;) {
    at += open.size();
    topics.push_back(publish.substr(at, publish.find(close, at) - at));
  }
  return topics;
}

Expected<std::string> signed_text(const std::string& text, X509& authority, EVP_PKEY& authority_key) {
  const int flags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM | PKCS7_NOSMIMECAP;
  const Bio in = reading(text), out = memory();
  const Pkcs7 signature(PKCS7_sign(&authority, &authority_key, nullptr, in.get(), flags));
  if (!signature || SMIME_write_PKCS7(out.get(), signature.get(), in.get(), flags) != 1)
    return tl::unexpected(openssl_failure("the document could not be signed"));
  return text_of(*out);
}

Expected<std::string> verified_text(const std::string& signed_text, X509& authority, Time now) {
  BIO* content = nullptr;
  const Pkcs7 signature(SMIME_read_PKCS7(reading(signed_text).get(), &content));
  const Bio in(content), out = memory();
  if (!signature || !in) return tl::unexpected(openssl_failure("it is no signed document"));
  const Store store(X509_STORE_new());
  if (!store || X509_STORE_add_cert(store.get(), &authority) != 1)
    return tl::unexpected(openssl_failure("the authority can't be used"));
  X509_VERIFY_PARAM_set_time(X509_STORE_get0_param(store.get()), std::chrono::system_clock::to_time_t(now));
  if (PKCS7_verify(signature.get(), nullptr, store.get(), in.get(), out.get(), PKCS7_TEXT) != 1)
    return tl::unexpected(openssl_failure("it was changed, or the lab's authority did not sign it"));
  return text_of(*out);
}

}  // namespace bodeflow::trust
