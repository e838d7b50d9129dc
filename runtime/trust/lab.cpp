#include "trust/lab.hpp"

#include <fmt/format.h>
#include <openssl/obj_mac.h>

#include <algorithm>
#include <cstdlib>

#include "trust/documents.hpp"
#include "trust/files.hpp"

namespace bodeflow::trust {
namespace {

namespace fs = std::filesystem;

/// They are sent in one datagram with the certificate and the participant's own data (transport::kSmallestSecureDatagram), which
/// take 2.4 KB here and 3 KB with the longest names.
constexpr std::size_t kMostPermissions = 4096;

/// What signs: read from the folder.
struct Authority {
  Certificate certificate;
  Key key;
  std::string lab() const { return subject_part(*certificate, NID_organizationName); }
};

template <class T>
Expected<T> in_file(const fs::path& path, Expected<T> read) {
  if (!read) return tl::unexpected(fmt::format("'{}': {}", path.string(), read.error()));
  return read;
}

Expected<Certificate> certificate_in(const fs::path& path) {
  return read_file(path).and_then([&](const std::string& text) { return in_file(path, read_certificate(text)); });
}

Expected<RevocationList> revocations_in(const fs::path& path) {
  return read_file(path).and_then([&](const std::string& text) { return in_file(path, read_revocations(text)); });
}

Expected<void> need_authority(const Files& files) {
  if (fs::exists(files.authority)) return {};
  return tl::unexpected(fmt::format("'{}' has no authority: begin with 'bodeflow trust init'", files.folder.string()));
}

Expected<Authority> read_authority(const Files& files) {
  if (auto there = need_authority(files); !there) return tl::unexpected(there.error());
  if (!fs::exists(files.authority_key))
    return tl::unexpected(
        fmt::format("'{}' has no key of the authority: hosts are added and revoked on the machine where "
                    "'bodeflow trust init' was run",
                    files.folder.string()));
  auto certificate = certificate_in(files.authority);
  if (!certificate) return tl::unexpected(certificate.error());
  auto key = read_file(files.authority_key).and_then([&](const std::string& text) {
    return in_file(files.authority_key, read_key(text));
  });
  if (!key) return tl::unexpected(key.error());
  if (X509_check_private_key(certificate->get(), key->get()) != 1)
    return tl::unexpected(
        openssl_failure(fmt::format("'{}' is not the key of '{}'", files.authority_key.string(), files.authority.string())));
  return Authority{std::move(*certificate), std::move(*key)};
}

Expected<Host> read_host(const Files& files, const std::string& name, X509_CRL& revocations) {
  auto certificate = certificate_in(files.certificate(name));
  if (!certificate) return tl::unexpected(certificate.error());
  auto permissions = read_file(files.permissions(name));
  if (!permissions) return tl::unexpected(permissions.error());
  X509& read = **certificate;
  return Host{name,
              fingerprint(read),
              valid_from(read),
              valid_until(read),
              is_revoked(read, revocations),
              permitted_topics(*permissions)};
}

/// Why a host of this name can't be added now, or nothing.
Expected<void> need_free_name(const Files& files, const NewHost& host, X509_CRL& revocations, Time now) {
  if (!fs::exists(files.hosts / host.name)) return {};
  auto present = read_host(files, host.name, revocations);
  if (!present) return tl::unexpected(present.error());
  if (present->revoked || present->until <= now) return {};
  return tl::unexpected(fmt::format("host '{}' has a certificate until {}; 'bodeflow trust revoke {}' comes before another one",
                                    host.name, utc_text(present->until), host.name));
}

Expected<void> check(const NewHost& host) {
  if (const std::string problem = name_problem(host.name); !problem.empty())
    return tl::unexpected(fmt::format("host name '{}': {}", host.name, problem));
  if (host.days < 1) return tl::unexpected(fmt::format("days {}: expected at least 1", host.days));
  if (host.topics.empty()) return tl::unexpected(std::string("a host without any topic could not join"));
  for (const std::string& topic : host.topics)
    if (const std::string problem = topic_problem(topic); !problem.empty())
      return tl::unexpected(fmt::format("topic '{}': {}", topic, problem));
  return {};
}

/// What a host needs; the paths as in a folder of trust.
Expected<std::vector<Archived>> bundle_of(const Files& files, const NewHost& host, const Authority& authority, Time now) {
  const auto key = make_key();
  if (!key) return tl::unexpected(key.error());
  const Time until = std::min(now + std::chrono::hours(24) * host.days, valid_until(*authority.certificate));
  const auto certificate = make_host(**key, host.name, *authority.certificate, *authority.key, now, until);
  if (!certificate) return tl::unexpected(certificate.error());
  const auto permissions =
      signed_text(permissions_text(host.name, authority.lab(), host.topics, now - kBackdated, until + kBackdated),
                  *authority.certificate, *authority.key);
  if (!permissions) return tl::unexpected(permissions.error());
  if (permissions->size() > kMostPermissions)
    return tl::unexpected(fmt::format("the permissions of host '{}' have {} bytes, {} are allowed: give fewer or shorter topics",
                                      host.name, permissions->size(), kMostPermissions));
  const auto governance = read_file(files.governance), revocations = read_file(files.revocations);
  if (!governance) return tl::unexpected(governance.error());
  if (!revocations) return tl::unexpected(revocations.error());
  const std::string own = "hosts/" + host.name + "/";
  return std::vector<Archived>{{"authority.pem", pem(*authority.certificate), kPublic},
                               {"governance.p7s", *governance, kPublic},
                               {"revoked.pem", *revocations, kPublic},
                               {"hosts/", "", 0700},
                               {own, "", 0700},
                               {own + "certificate.pem", pem(**certificate), kPublic},
                               {own + "key.pem", pem(**key), kPrivate},
                               {own + "permissions.p7s", *permissions, kPublic}};
}

/// The host's own files into the folder, in the place of those of an earlier certificate.
Expected<void> keep(const Files& files, const std::string& host, const std::vector<Archived>& bundle) {
  auto staging = Staging::beside(files.hosts / host);
  if (!staging) return tl::unexpected(staging.error());
  const std::string own = "hosts/" + host + "/";
  for (const Archived& file : bundle)
    if (file.name.size() > own.size() && file.name.compare(0, own.size(), own) == 0)
      if (auto written = write_new(staging->path() / file.name.substr(own.size()), file.content, file.mode); !written)
        return written;
  std::error_code error;
  fs::remove_all(files.hosts / host, error);
  if (error) return tl::unexpected(fmt::format("'{}': {}", (files.hosts / host).string(), error.message()));
  return staging->becomes(files.hosts / host);
}

}  // namespace

Files::Files(fs::path given)
    : folder((given.has_filename() ? given : given.parent_path()).lexically_normal()),
      authority(folder / "authority.pem"),
      authority_key(folder / "authority.key"),
      governance(folder / "governance.p7s"),
      revocations(folder / "revoked.pem"),
      hosts(folder / "hosts") {}

fs::path default_folder() {
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
  };
  if (const fs::path own = variable("BODEFLOW_TRUST"); !own.empty()) return own;
  if (const fs::path config = variable("XDG_CONFIG_HOME"); config.is_absolute()) return config / "bodeflow" / "trust";
  if (const fs::path home = variable("HOME"); home.is_absolute()) return home / ".config" / "bodeflow" / "trust";
  return {};
}

std::string name_problem(const std::string& name) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (name.empty() || name.size() > 64 || name.find_first_not_of(kAllowed) != std::string::npos || name.front() == '-')
    return "expected 1 to 64 letters, digits, _ and -, no - first";
  return "";
}

std::string topic_problem(const std::string& pattern) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-/.:*?";
  if (pattern.empty() || pattern.find_first_not_of(kAllowed) != std::string::npos)
    return "expected letters, digits, _ - / . : and the wildcards * and ?";
  return "";
}

Expected<void> init(const fs::path& folder, const NewLab& lab, Time now) {
  if (const std::string problem = name_problem(lab.name); !problem.empty())
    return tl::unexpected(fmt::format("name of the lab '{}': {}", lab.name, problem));
  if (lab.days < 1) return tl::unexpected(fmt::format("days {}: expected at least 1", lab.days));
  const Files files(fs::absolute(folder));
  std::error_code error;
  if (fs::exists(files.folder, error) && !fs::is_empty(files.folder, error))
    return tl::unexpected(fmt::format("'{}' exists already and is not empty", files.folder.string()));

  const auto key = make_key();
  if (!key) return tl::unexpected(key.error());
  const auto authority = make_authority(**key, lab.name, now, now + std::chrono::hours(24) * lab.days);
  if (!authority) return tl::unexpected(authority.error());
  const auto revocations = make_revocations(nullptr, nullptr, **authority, **key, now);
  if (!revocations) return tl::unexpected(revocations.error());
  const auto governance = signed_text(governance_text(), **authority, **key);
  if (!governance) return tl::unexpected(governance.error());

  auto staging = Staging::beside(files.folder);
  if (!staging) return tl::unexpected(staging.error());
  const Files made(staging->path());
  return write_new(made.authority, pem(**authority), kPublic)
      .and_then([&] { return write_new(made.authority_key, pem(**key), kPrivate); })
      .and_then([&] { return write_new(made.governance, *governance, kPublic); })
      .and_then([&] { return write_new(made.revocations, pem(**revocations), kPublic); })
      .and_then([&] { return staging->becomes(files.folder); });
}

Expected<Host> add(const fs::path& folder, const NewHost& host, Time now) {
  const Files files(folder);
  if (auto right = check(host); !right) return tl::unexpected(right.error());
  if (auto there = need_authority(files); !there) return tl::unexpected(there.error());
  const auto lock = Lock::of(files.folder);
  if (!lock) return tl::unexpected(lock.error());
  const auto authority = read_authority(files);
  if (!authority) return tl::unexpected(authority.error());
  if (valid_until(*authority->certificate) <= now)
    return tl::unexpected(fmt::format("the lab's authority expired on {}", utc_text(valid_until(*authority->certificate))));
  const auto revocations = revocations_in(files.revocations);
  if (!revocations) return tl::unexpected(revocations.error());
  if (auto free = need_free_name(files, host, **revocations, now); !free) return tl::unexpected(free.error());
  if (fs::exists(host.bundle)) return tl::unexpected(fmt::format("'{}' exists already", host.bundle.string()));

  const auto bundle = bundle_of(files, host, *authority, now);
  if (!bundle) return tl::unexpected(bundle.error());
  const std::string archive = tar(*bundle, static_cast<long>(std::chrono::system_clock::to_time_t(now)));
  if (auto written = write_new(host.bundle, archive, kPrivate); !written) return tl::unexpected(written.error());
  if (auto kept = keep(files, host.name, *bundle); !kept) {
    std::error_code ignored;
    fs::remove(host.bundle, ignored);
    return tl::unexpected(kept.error());
  }
  return read_host(files, host.name, **revocations);
}

Expected<Host> revoke(const fs::path& folder, const std::string& host, Time now) {
  const Files files(folder);
  if (auto there = need_authority(files); !there) return tl::unexpected(there.error());
  const auto lock = Lock::of(files.folder);
  if (!lock) return tl::unexpected(lock.error());
  const auto authority = read_authority(files);
  if (!authority) return tl::unexpected(authority.error());
  if (!name_problem(host).empty() || !fs::exists(files.hosts / host))
    return tl::unexpected(fmt::format("there is no host '{}'; 'bodeflow trust list' shows them", host));
  const auto previous = revocations_in(files.revocations);
  if (!previous) return tl::unexpected(previous.error());
  const auto certificate = certificate_in(files.certificate(host));
  if (!certificate) return tl::unexpected(certificate.error());
  if (is_revoked(**certificate, **previous)) return tl::unexpected(fmt::format("host '{}' is revoked already", host));

  const auto list = make_revocations(previous->get(), certificate->get(), *authority->certificate, *authority->key, now);
  if (!list) return tl::unexpected(list.error());
  if (auto written = replace(files.revocations, pem(**list), kPublic); !written) return tl::unexpected(written.error());
  return read_host(files, host, **list);
}

Expected<bool> take_revocations(const fs::path& folder, const std::string& pem) {
  const Files files(folder);
  const auto lock = Lock::of(files.folder);
  if (!lock) return tl::unexpected(lock.error());
  const auto authority = certificate_in(files.authority);
  if (!authority) return tl::unexpected(authority.error());
  const auto given = read_revocations(pem);
  if (!given) return tl::unexpected(given.error());
  if (X509_CRL_verify(given->get(), X509_get0_pubkey(authority->get())) != 1)
    return tl::unexpected(openssl_failure("the list of revoked certificates is not of the lab's authority"));
  const auto present = revocations_in(files.revocations);
  if (!present) return tl::unexpected(present.error());
  if (number(**given) <= number(**present)) return false;
  return replace(files.revocations, trust::pem(**given), kPublic).map([] { return true; });
}

Expected<Lab> list(const fs::path& folder) {
  const Files files(folder);
  if (auto there = need_authority(files); !there) return tl::unexpected(there.error());
  const auto authority = certificate_in(files.authority);
  if (!authority) return tl::unexpected(authority.error());
  const auto revocations = revocations_in(files.revocations);
  if (!revocations) return tl::unexpected(revocations.error());
  Lab lab{subject_part(**authority, NID_organizationName),
          fingerprint(**authority),
          valid_from(**authority),
          valid_until(**authority),
          fs::exists(files.authority_key),
          {}};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(files.hosts, error)) {
    const std::string name = entry.path().filename().string();
    if (!name_problem(name).empty()) continue;
    auto host = read_host(files, name, **revocations);
    if (!host) return tl::unexpected(host.error());
    lab.hosts.push_back(std::move(*host));
  }
  std::sort(lab.hosts.begin(), lab.hosts.end(), [](const Host& a, const Host& b) { return a.name < b.name; });
  return lab;
}

}  // namespace bodeflow::trust
