#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trust/certificate.hpp"

namespace bodeflow::trust {

// A folder of trust:
//   authority.pem    certificate of the lab's authority
//   authority.key    its key, on the machine that adds and revokes hosts only
//   governance.p7s   rules of the lab, signed
//   revoked.pem      list of revoked certificates, signed
//   hosts/NAME/      certificate.pem, key.pem, permissions.p7s of a host; on a host only its own
struct Files {
  explicit Files(std::filesystem::path folder);
  std::filesystem::path folder, authority, authority_key, governance, revocations, hosts;

  std::filesystem::path certificate(const std::string& host) const { return hosts / host / "certificate.pem"; }
  std::filesystem::path key(const std::string& host) const { return hosts / host / "key.pem"; }
  std::filesystem::path permissions(const std::string& host) const { return hosts / host / "permissions.p7s"; }
};

/// $BODEFLOW_TRUST, else $XDG_CONFIG_HOME/bodeflow/trust, else ~/.config/bodeflow/trust; empty where none of them is set.
std::filesystem::path default_folder();

/// What is wrong with the name of a host or a lab, or "": letters, digits, _ and -, at most 64 (RFC 5280).
std::string name_problem(const std::string& name);
/// What is wrong with a pattern of topics, or "".
std::string topic_problem(const std::string& pattern);

struct NewLab {
  std::string name = "lab";
  int days = 3650;
};
/// Makes a folder with a new authority and nobody in it. Error: also where the folder exists and is not empty.
Expected<void> init(const std::filesystem::path& folder, const NewLab& lab, Time now);

struct NewHost {
  std::string name;
  int days = 730;  ///< at most as long as the authority
  std::vector<std::string> topics{"bodeflow/*"};
  std::filesystem::path bundle;  ///< the tar archive to be unpacked in the host's folder of trust
};
struct Host {
  std::string name, fingerprint;
  Time from, until;
  bool revoked = false;
  std::vector<std::string> topics;
};
/// Makes key, certificate and permissions of a host, and its bundle. Error: also where the host has a certificate that is
/// neither revoked nor expired, or the bundle's file exists; then nothing has changed.
Expected<Host> add(const std::filesystem::path& folder, const NewHost& host, Time now);

/// Puts a host's certificate on the list of revoked ones. A participant reads the list when it joins; so the other hosts need
/// the new list, and must join anew, before they refuse that host's next join.
Expected<Host> revoke(const std::filesystem::path& folder, const std::string& host, Time now);

/// Replaces the list of revoked certificates of a folder by a later one (PEM) of the same authority; false where it is not
/// later. Error: it is another authority's, or no list.
Expected<bool> take_revocations(const std::filesystem::path& folder, const std::string& pem);

struct Lab {
  std::string name, fingerprint;  ///< of the authority
  Time from, until;
  bool has_key = false;     ///< hosts can be added and revoked here
  std::vector<Host> hosts;  ///< by name
};
Expected<Lab> list(const std::filesystem::path& folder);

}  // namespace bodeflow::trust
