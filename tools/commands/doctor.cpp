#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "commands/command.hpp"
#include "commands/real_time_findings.hpp"
#include "commands/vector_level.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {
namespace {

Finding processor() {
  return {"processor", "good",
          fmt::format("{} cores, {}", std::thread::hardware_concurrency(), vector_level_name(processor_vector_level())), ""};
}

Finding plugins(const Registry& registry) {
  std::size_t usable = 0;
  std::string refused;
  for (const auto& plugin : registry.plugins()) {
    if (plugin.refused.empty())
      ++usable;
    else
      refused += fmt::format("\n{:>24}{}: {}", "", plugin.file, plugin.refused);
  }
  if (usable == 0) return {"plugins", "bad", "none", "give --path DIR or set BODEFLOW_PLUGIN_PATH" + refused};
  return {"plugins", refused.empty() ? "good" : "bad",
          fmt::format("{} usable, {} blocks, {} effects, {} base models", usable, registry.ids().size(),
                      registry.effects().size(), registry.base_models().size()),
          refused.empty() ? "" : "refused:" + refused};
}

Finding runs_folder() {
  const bool writable = access(".", W_OK) == 0;
  std::error_code error;
  const auto space = std::filesystem::space(".", error);
  const double gigabytes = error ? 0.0 : static_cast<double>(space.available) / 1e9;
  if (!writable) return {"run directories", "bad", "the working directory can't be written", "run elsewhere, or give --out DIR"};
  if (gigabytes < 1.0)
    return {"run directories", "note", fmt::format("{:.2f} GB free", gigabytes), "make room before long recordings"};
  return {"run directories", "good", fmt::format("{:.1f} GB free here", gigabytes), ""};
}

Finding graphviz() {
  const bool found = std::system("command -v dot >/dev/null 2>&1") == 0;
  return {"Graphviz", found ? "good" : "note", found ? "found" : "absent",
          found ? "" : "apt-get install graphviz, for 'bodeflow graph --format svg'"};
}

int doctor(const Session& session, bool as_json) {
  const Registry registry = session.open_registry();
  std::vector<Finding> findings{processor(), plugins(registry), runs_folder(), graphviz()};
  for (auto& finding : real_time_findings()) findings.push_back(std::move(finding));
  bool bad = false;
  nlohmann::ordered_json all = nlohmann::json::array();
  for (const auto& finding : findings) {
    bad |= finding.state == "bad";
    all.push_back({{"what", finding.what}, {"state", finding.state}, {"found", finding.found}, {"advice", finding.advice}});
    if (!as_json)
      fmt::print("{:<5} {:<18} {}{}\n", finding.state, finding.what, finding.found,
                 finding.advice.empty() ? "" : "; " + finding.advice);
  }
  if (as_json) print_json(all);
  return bad ? kRunFailed : kDone;
}

}  // namespace

void add_doctor(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("doctor", "Tell what this machine has and lacks, and how to set it");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON");
  command->callback([&session, json] { session.action = [&session, json] { return doctor(session, *json); }; });
}

}  // namespace bodeflow::tools
