#include "trust/security.hpp"

#include <fmt/format.h>
#include <openssl/obj_mac.h>
#include <sys/stat.h>

#include <algorithm>

#include "trust/documents.hpp"
#include "trust/files.hpp"
#include "trust/lab.hpp"

namespace bodeflow::trust {
namespace {

namespace fs = std::filesystem;

tl::unexpected<std::string> problem_of(const fs::path& path, const std::string& what) {
  return tl::unexpected(fmt::format("'{}': {}", path.string(), what));
}

/// The names of the hosts that the folder has.
std::string hosts_of(const Files& files) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(files.hosts, error))
    if (const std::string name = entry.path().filename().string(); name_problem(name).empty()) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

Expected<void> check_present(const Files& files, const std::string& host) {
  if (!name_problem(host).empty()) return tl::unexpected(fmt::format("host name '{}': {}", host, name_problem(host)));
  if (fs::exists(files.authority) && !fs::exists(files.hosts / host))
    return tl::unexpected(fmt::format("'{}' has no certificate of host '{}', but of: {}; 'bodeflow trust add {}' makes one",
                                      files.folder.string(), host, hosts_of(files), host));
  for (const fs::path& path :
       {files.authority, files.governance, files.revocations, files.certificate(host), files.key(host), files.permissions(host)})
    if (!fs::exists(path)) return problem_of(path, "is missing; unpack the host's bundle again");
  return {};
}

tl::unexpected<std::string> too_early(const fs::path& path, Time from, Time now) {
  return problem_of(path,
                    fmt::format("valid from {}, and it is {}: is this machine's clock right?", utc_text(from), utc_text(now)));
}

Expected<void> check_time(const fs::path& path, const X509& certificate, Time now) {
  if (now < valid_from(certificate)) return too_early(path, valid_from(certificate), now);
  if (now >= valid_until(certificate)) return problem_of(path, "expired on " + utc_text(valid_until(certificate)));
  return {};
}

Expected<void> check_key(const fs::path& path, X509& certificate) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && (status.st_mode & 077U) != 0)
    return problem_of(path, fmt::format("others can read this key (mode {:04o}); chmod 600 it", status.st_mode & 07777U));
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto key = read_key(*text);
  if (!key) return problem_of(path, key.error());
  if (X509_check_private_key(&certificate, key->get()) != 1)
    return problem_of(path, openssl_failure("it is not the key of certificate.pem"));
  return {};
}

Expected<void> check_revocations(const fs::path& path, X509& authority, X509& certificate, const std::string& host, Time now) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto list = read_revocations(*text);
  if (!list) return problem_of(path, list.error());
  if (X509_CRL_verify(list->get(), X509_get0_pubkey(&authority)) != 1)
    return problem_of(path, openssl_failure("it is of another authority than authority.pem"));
  if (now < valid_from(**list)) return too_early(path, valid_from(**list), now);
  if (is_revoked(certificate, **list)) return problem_of(path, fmt::format("the certificate of host '{}' is revoked", host));
  return {};
}

Expected<std::string> check_document(const fs::path& path, X509& authority, Time now) {
  const auto text = read_file(path);
  if (!text) return text;
  const auto content = verified_text(*text, authority, now);
  if (!content) return problem_of(path, content.error());
  return content;
}

Expected<void> check_certificate(const Files& files, const std::string& host, X509& authority, X509& certificate, Time now) {
  const fs::path path = files.certificate(host);
  if (X509_verify(&certificate, X509_get0_pubkey(&authority)) != 1)
    return problem_of(path, openssl_failure("it is of another authority than authority.pem"));
  if (const std::string name = subject_part(certificate, NID_commonName); name != host)
    return problem_of(path, fmt::format("it is the certificate of '{}', not of '{}'", name, host));
  return check_time(files.authority, authority, now).and_then([&] { return check_time(path, certificate, now); });
}

Expected<void> check_documents(const Files& files, const std::string& host, X509& authority, Time now) {
  const auto governance = check_document(files.governance, authority, now);
  if (!governance) return tl::unexpected(governance.error());
  const auto permissions = check_document(files.permissions(host), authority, now);
  if (!permissions) return tl::unexpected(permissions.error());
  const std::string subject = fmt::format("CN={},O={}", host, subject_part(authority, NID_organizationName));
  if (permissions->find("<subject_name>" + subject + "</subject_name>") == std::string::npos)
    return problem_of(files.permissions(host), fmt::format("it grants nothing to '{}'", subject));
  return {};
}

}  // namespace

Expected<std::optional<transport::Security>> security_of(const fs::path& folder, const std::string& host, Time now) {
  std::error_code error;
  if (folder.empty() || !fs::exists(folder, error) || fs::is_empty(folder, error))
    if (!error) return std::nullopt;
  if (error) return problem_of(folder, error.message());
  const Files files(fs::absolute(folder));
  if (auto present = check_present(files, host); !present) return tl::unexpected(present.error());

  const auto read = [](const fs::path& path) -> Expected<Certificate> {
    const auto text = read_file(path);
    if (!text) return tl::unexpected(text.error());
    auto certificate = read_certificate(*text);
    if (!certificate) return problem_of(path, certificate.error());
    return certificate;
  };
  const auto authority = read(files.authority), certificate = read(files.certificate(host));
  if (!authority) return tl::unexpected(authority.error());
  if (!certificate) return tl::unexpected(certificate.error());
  const auto right = check_certificate(files, host, **authority, **certificate, now)
                         .and_then([&] { return check_key(files.key(host), **certificate); })
                         .and_then([&] { return check_revocations(files.revocations, **authority, **certificate, host, now); })
                         .and_then([&] { return check_documents(files, host, **authority, now); });
  if (!right) return tl::unexpected(right.error());
  return transport::Security{files.authority,  files.certificate(host), files.key(host),
                             files.governance, files.permissions(host), files.revocations};
}

}  // namespace bodeflow::trust
