#include "commands/lab_options.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <thread>

#include "commands/vector_level.hpp"
#include "trust/lab.hpp"
#include "trust/security.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

/// The only host whose certificate lies in the folder, or "".
std::string only_host(const fs::path& folder) {
  std::string host;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(trust::Files(folder).hosts, error)) {
    if (!host.empty()) return "";
    host = entry.path().filename().string();
  }
  return host;
}

bool only_loopback(const std::vector<std::string>& interfaces) {
  for (const std::string& address : interfaces)
    if (address.rfind("127.", 0) != 0) return false;
  return !interfaces.empty();
}

transport::Settings::Carrier carrier_named(const std::string& name) {
  using Carrier = transport::Settings::Carrier;
  if (name == "udp") return Carrier::udp;
  if (name == "tcp") return Carrier::tcp;
  return name == "shared-memory" ? Carrier::shared_memory : Carrier::automatic;
}

}  // namespace

void LabOptions::add_to(CLI::App& app) {
  app.add_flag("--loopback", loopback, "Lab on this machine alone: nobody else is let in")->group("Lab");
  app.add_option("--trust", trust, "Folder of trust (see 'bodeflow trust'; the usual one otherwise)")
      ->type_name("DIR")
      ->group("Lab");
  app.add_flag("--let-anyone-on-the-network-in", let_anyone_in,
               "No certificates: whoever reaches this machine's network may run graphs in this lab")
      ->group("Lab");
  add_network_to(app);
}

void LabOptions::add_network_to(CLI::App& app) {
  app.add_option("--interface", interfaces, "IP address of an interface to use (all otherwise)")
      ->allow_extra_args(false)
      ->group("Lab");
  app.add_option("--peer", peers, "Address of a machine, where multicast does not work")->allow_extra_args(false)->group("Lab");
  app.add_option("--discovery-server", server, "Address:port of a Fast DDS discovery server")->group("Lab");
  app.add_option("--carrier", carrier, "automatic: shared memory on a machine, UDP between machines")
      ->check(CLI::IsMember({"automatic", "udp", "tcp", "shared-memory"}))
      ->group("Lab");
  app.add_option("--domain", domain, "DDS domain: labs of different domains do not see each other")
      ->check(CLI::Range(0, 232))
      ->group("Lab");
}

fs::path LabOptions::trust_folder() const { return trust.empty() ? trust::default_folder() : fs::path(trust); }

tl::expected<transport::Settings, std::string> LabOptions::settings(const std::string& host) const {
  transport::Settings made;
  made.name = host.empty() ? "bodeflow" : "bodeflow " + host;
  made.domain = domain;
  made.carrier = carrier_named(carrier);
  made.interfaces = interfaces;
  if (loopback) made.interfaces = {"127.0.0.1"};
  made.peers = peers;
  if (!peers.empty()) made.discovery = transport::Settings::Discovery::peers;
  if (!server.empty()) {
    made.discovery = transport::Settings::Discovery::server;
    made.peers = {server};
  }
  if (only_loopback(made.interfaces) && trust.empty()) return made;
  if (let_anyone_in) return made;
  const fs::path folder = trust_folder();
  const std::string name = host.empty() && !folder.empty() ? only_host(folder) : host;
  if (!folder.empty() && fs::exists(folder)) {
    auto security = trust::security_of(folder, name);
    if (!security) return tl::unexpected(security.error());
    made.security = *security;
  }
  if (made.security) return made;
  return tl::unexpected(fmt::format(
      "this machine has no certificate of a lab{}: unpack the bundle that 'bodeflow trust add' made, or give --loopback "
      "(this machine alone), or --let-anyone-on-the-network-in (no protection at all)",
      folder.empty() ? "" : " in '" + folder.string() + "'"));
}

tl::expected<std::shared_ptr<transport::Participant>, ExitCode> LabOptions::join() const {
  const auto made = settings("");
  if (!made) {
    say_error(made.error());
    return tl::unexpected(kUsage);
  }
  auto participant = transport::join(*made);
  if (participant) return std::move(*participant);
  say_error(participant.error());
  return tl::unexpected(kDevice);
}

lab::AgentInfo this_machine(const Session&, const Registry& registry, const std::string& name) {
  lab::AgentInfo info;
  info.name = name;
  info.version = BODEFLOW_VERSION;
  utsname system{};
  uname(&system);
  info.system = fmt::format("{} {}", system.nodename, system.machine);
  info.vector_level = processor_vector_level();
  info.processors = static_cast<int>(std::thread::hardware_concurrency());
  for (const PluginDescription& plugin : registry.plugins())
    if (plugin.refused.empty()) info.plugins.push_back({plugin.name, plugin.version, plugin.sha256});
  return info;
}

}  // namespace bodeflow::tools
