#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "commands/lab_options.hpp"
#include "console/json_output.hpp"
#include "trust/lab.hpp"

namespace bodeflow::tools {
namespace {

using trust::utc_text;

struct Options {
  std::string folder;  ///< --dir
  bool json = false;
  trust::NewLab lab;
  trust::NewHost host;
  std::string bundle;
  std::string tell_as;  ///< host in whose name the new list is sent to the agents
  LabOptions network;

  std::filesystem::path where() const {
    const std::filesystem::path path = folder.empty() ? trust::default_folder() : std::filesystem::path(folder);
    if (path.empty()) throw std::runtime_error("where? give --dir DIR or set BODEFLOW_TRUST");
    return std::filesystem::absolute(path);
  }
};

trust::Time now() { return std::chrono::system_clock::now(); }

int failed(const std::string& why, int code = kRunFailed) {
  say_error(why);
  return code;
}

std::string state_of(const trust::Host& host) {
  if (host.revoked) return "revoked";
  if (host.until <= now()) return "expired";
  return host.from > now() ? "not yet" : "valid";
}

nlohmann::ordered_json json_of(const trust::Host& host) {
  return {{"host", host.name},
          {"state", state_of(host)},
          {"valid_from", utc_text(host.from)},
          {"valid_until", utc_text(host.until)},
          {"topics", host.topics},
          {"fingerprint", host.fingerprint}};
}

int init_lab(const Options& options) {
  if (const std::string problem = trust::name_problem(options.lab.name); !problem.empty())
    return failed(fmt::format("name of the lab '{}': {}", options.lab.name, problem), kUsage);
  const auto where = options.where();
  if (auto made = trust::init(where, options.lab, now()); !made) return failed(made.error());
  const auto lab = trust::list(where);
  if (!lab) return failed(lab.error());
  if (options.json) {
    print_json(nlohmann::ordered_json{{"folder", where.string()},
                                      {"lab", lab->name},
                                      {"valid_until", utc_text(lab->until)},
                                      {"fingerprint", lab->fingerprint}});
    return kDone;
  }
  fmt::print("Made the authority of lab '{}' in {}, valid until {}.\n", lab->name, where.string(), utc_text(lab->until));
  fmt::print("Who has authority.key can let anybody in: keep this folder on one machine, and a copy in a safe place.\n");
  fmt::print("Next, for each machine: bodeflow trust add HOST\n");
  return kDone;
}

int add_host(Options options) {
  if (const std::string problem = trust::name_problem(options.host.name); !problem.empty())
    return failed(fmt::format("host name '{}': {}", options.host.name, problem), kUsage);
  for (const std::string& topic : options.host.topics)
    if (const std::string problem = trust::topic_problem(topic); !problem.empty())
      return failed(fmt::format("--topic '{}': {}", topic, problem), kUsage);
  options.host.bundle = options.bundle.empty() ? options.host.name + ".tar" : options.bundle;
  const auto host = trust::add(options.where(), options.host, now());
  if (!host) return failed(host.error());
  const std::string bundle = options.host.bundle.string();
  if (options.json) {
    auto all = json_of(*host);
    all["bundle"] = bundle;
    print_json(all);
    return kDone;
  }
  fmt::print("Host '{}' is trusted until {}. Its key is in {}; copy that by a safe way, unpack it on the host, and delete it:\n",
             host->name, utc_text(host->until), bundle);
  fmt::print("  mkdir -p ~/.config/bodeflow/trust && tar -xf {} -C ~/.config/bodeflow/trust\n",
             options.host.bundle.filename().string());
  return kDone;
}

int list_hosts(const Options& options) {
  const auto where = options.where();
  const auto lab = trust::list(where);
  if (!lab) return failed(lab.error());
  if (options.json) {
    nlohmann::ordered_json hosts = nlohmann::json::array();
    for (const trust::Host& host : lab->hosts) hosts.push_back(json_of(host));
    print_json(nlohmann::ordered_json{{"folder", where.string()},
                                      {"lab", lab->name},
                                      {"authority",
                                       {{"valid_from", utc_text(lab->from)},
                                        {"valid_until", utc_text(lab->until)},
                                        {"fingerprint", lab->fingerprint},
                                        {"key", lab->has_key}}},
                                      {"hosts", hosts}});
    return kDone;
  }
  const auto row = [](const std::string& name, const std::string& state, trust::Time until, const std::string& fingerprint) {
    fmt::print("{:<20} {:<8} until {}  {}\n", name, state, utc_text(until), dim(fingerprint));
  };
  fmt::print("Lab '{}' in {}{}\n", lab->name, where.string(), lab->has_key ? "" : ", without the authority's key");
  row("authority", lab->until <= now() ? "expired" : "valid", lab->until, lab->fingerprint);
  for (const trust::Host& host : lab->hosts) row(host.name, state_of(host), host.until, host.fingerprint);
  return kDone;
}

using Participant = std::shared_ptr<transport::Participant>;

/// The lab, joined as host --tell-as; nobody without that option. With the list as it still is: who is about to be revoked hears
/// of it too.
tl::expected<Participant, std::string> join_lab(const Options& options, const std::filesystem::path& where) {
  if (options.tell_as.empty()) return Participant();
  LabOptions network = options.network;
  network.trust = where.string();
  const auto settings = network.settings(options.tell_as);
  if (!settings) return tl::unexpected(settings.error());
  return transport::join(*settings);
}

int tell_agents(const Participant& participant, const std::string& list, bool quiet) {
  std::ifstream in(list);
  const std::string pem{std::istreambuf_iterator<char>(in), {}};
  const auto told = lab::tell_revocations(participant, pem, 3.0);
  if (!told) return failed(told.error(), kDevice);
  if (quiet) return kDone;
  for (const std::string& agent : *told) fmt::print("The agent of '{}' has been sent the new list and joins anew.\n", agent);
  if (told->empty()) fmt::print("No agent is in the lab now.\n");
  return kDone;
}

int revoke_host(const Options& options) {
  const auto where = options.where();
  const auto participant = join_lab(options, where);
  if (!participant) return failed(participant.error(), kDevice);
  const auto host = trust::revoke(where, options.host.name, now());
  if (!host) return failed(host.error());
  const std::string list = trust::Files(where).revocations.string();
  if (options.json) {
    auto all = json_of(*host);
    all["revocations"] = list;
    print_json(all);
  } else {
    fmt::print("Host '{}' is revoked.\n", host->name);
  }
  if (*participant) return tell_agents(*participant, list, options.json);
  if (options.json) return kDone;
  fmt::print("The other hosts refuse it from their next start with the new list on:\n");
  fmt::print("copy {} into the folder of trust of each, and restart their agents;\n", list);
  fmt::print("or let --tell-as HOST send it to all agents of the lab.\n");
  return kDone;
}

}  // namespace

void add_trust(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("trust", "Say who may join the lab's network: init, add HOST, list, revoke HOST");
  command->require_subcommand(1);
  command->fallthrough();
  auto options = std::make_shared<Options>();
  command->add_option("--dir", options->folder, "The folder of trust, instead of BODEFLOW_TRUST or ~/.config/bodeflow/trust")
      ->type_name("DIR");
  command->add_flag("--json", options->json, "Print JSON");

  auto* init = command->add_subcommand("init", "Make an authority for the lab, once, on one machine");
  init->add_option("--lab", options->lab.name, "Name of the lab")->type_name("NAME")->capture_default_str();
  init->add_option("--days", options->lab.days, "How long the authority is valid")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  init->callback([&session, options] { session.action = [options] { return init_lab(*options); }; });

  auto* add = command->add_subcommand("add", "Make the certificate of a host, and the archive that brings it there");
  add->add_option("host", options->host.name, "Name of the host")->required();
  add->add_option("--days", options->host.days, "How long its certificate is valid, at most as long as the authority")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  add->add_option("--topic", options->host.topics, "A pattern of topics that it may read and write, instead of bodeflow/*")
      ->type_name("PATTERN")
      ->allow_extra_args(false);
  add->add_option("--out", options->bundle, "The archive, HOST.tar by default")->type_name("FILE");
  add->callback([&session, options] { session.action = [options] { return add_host(*options); }; });

  auto* list = command->add_subcommand("list", "List the hosts, until when they are trusted, and which are revoked");
  list->callback([&session, options] { session.action = [options] { return list_hosts(*options); }; });

  auto* revoke = command->add_subcommand("revoke", "Put a host on the list of those that are no longer trusted");
  revoke->add_option("host", options->host.name, "Name of the host")->required();
  revoke->add_option("--tell-as", options->tell_as, "Send the new list to all agents of the lab, in the name of this host")
      ->type_name("HOST");
  options->network.add_network_to(*revoke);
  revoke->callback([&session, options] { session.action = [options] { return revoke_host(*options); }; });
}

}  // namespace bodeflow::tools
