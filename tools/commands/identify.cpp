#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands/data_source.hpp"
#include "commands/methods.hpp"
#include "commands/one_off.hpp"

namespace bodeflow::tools {
namespace {

struct IdentifyCommand {
  DataOptions data;
  std::string method, order, period, skip;
  std::vector<std::string> sets;
  std::string out;
  bool json = false;
};

/// Why the command can't be; empty: it can.
using Refusal = std::string;

bool has(const BlockDescription& method, const char* parameter) { return method.parameter(parameter) >= 0; }

bool takes_samples(const BlockDescription& method) {
  const auto* input = method.port(BF_IN, "input");
  const auto* output = method.port(BF_IN, "output");
  return input != nullptr && output != nullptr && input->kind == BF_STREAM && output->kind == BF_STREAM;
}

bool takes_response(const BlockDescription& method) {
  const auto* response = method.port(BF_IN, "response");
  return response != nullptr && response->kind == BF_MESSAGE;
}

std::string parameters_of(const BlockDescription& block) {
  std::string names;
  for (const auto& parameter : block.parameters) names += (names.empty() ? "" : ", ") + parameter.name;
  return names.empty() ? "none" : names;
}

/// The graph of one identification, as it grows.
class IdentifyGraph {
 public:
  IdentifyGraph(const IdentifyCommand& command, const BlockDescription& method, DataKind kind)
      : command_(command), method_(method), kind_(kind) {}

  /// Blocks and connections.
  Refusal build() {
    blocks_ = {{"data", data_block(command_.data, kind_)}};
    Refusal refusal = kind_ == DataKind::frequency_response ? from_response_file() : from_samples();
    if (refusal.empty()) refusal = set_order();
    if (refusal.empty()) blocks_.emplace_back("identify", fmt::format("{{block: {}{}}}", method_.id, settings_));
    return refusal;
  }

  /// PARAM=VALUE of the method, or BLOCK.PARAM=VALUE of another block, as overrides of the graph.
  Refusal set(const std::string& text) {
    const auto equal = text.find('=');
    if (equal == std::string::npos || equal == 0) return fmt::format("--set '{}': expected PARAM=VALUE, such as band=1:50", text);
    const std::string name = text.substr(0, equal), value = text.substr(equal + 1);
    if (has(method_, name.c_str())) {
      overrides.emplace_back("blocks.identify." + name, value);
      return {};
    }
    const std::string block = name.substr(0, name.find('.'));
    for (const auto& [known, line] : blocks_) {
      if (known != block || known == "identify" || block == name) continue;
      overrides.emplace_back("blocks." + name, value);
      return {};
    }
    std::vector<std::string> names;
    for (const auto& parameter : method_.parameters) names.push_back(parameter.name);
    return fmt::format("--set {}: {} has no parameter '{}'{}; it has: {}", name, method_.id, name, did_you_mean(name, names),
                       parameters_of(method_));
  }

  std::string text() const {
    const auto& d = command_.data;
    const std::string file = std::filesystem::path(d.file).filename().string();
    std::string title = d.inputs.empty() || kind_ == DataKind::frequency_response
                            ? fmt::format("Identify {} by {}", file, method_.id)
                            : fmt::format("Identify {} from {} of {} by {}", fmt::join(d.outputs, ", "),
                                          fmt::join(d.inputs, ", "), file, method_.id);
    std::string graph = fmt::format("bodeflow: 1\ntitle: {}\nsummary: {{show: [identify]}}\nrun: {{clock: simulated}}\nblocks:\n",
                                    yaml_text(title));
    for (const auto& [name, line] : blocks_) graph += fmt::format("  {}: {}\n", name, line);
    graph += "connections:\n";
    for (const auto& connection : connections_) graph += "  - " + connection + "\n";
    return graph;
  }

  std::vector<std::pair<std::string, std::string>> overrides;

 private:
  Refusal from_response_file() {
    if (!takes_response(method_))
      return fmt::format("{} holds a frequency response; {} needs the samples of input and output", command_.data.file,
                         method_.id);
    for (const auto& [option, value] :
         {std::pair{"--period", command_.period}, {"--skip", command_.skip}, {"--rate", command_.data.rate}})
      if (!value.empty()) return fmt::format("{}: {} holds a frequency response, not samples", option, command_.data.file);
    connections_ = {"data -> identify.response"};
    return {};
  }

  Refusal from_samples() {
    if (!command_.skip.empty() && command_.period.empty()) return "--skip counts periods: it needs --period, the samples of one";
    const bool own_period = has(method_, "period");
    if (takes_samples(method_) && (command_.period.empty() || own_period || !takes_response(method_))) {
      if (!command_.period.empty() && !own_period)
        return fmt::format("--period: {} takes the whole record and has no use for it", method_.id);
      add_setting("period", command_.period);
      if (!command_.skip.empty() && !has(method_, "skip")) return fmt::format("--skip: {} skips no periods", method_.id);
      add_setting("skip", command_.skip);
      connections_ = {"data.input -> identify.input", "data.output -> identify.output"};
      return {};
    }
    if (!takes_response(method_))
      return fmt::format("{} has neither the inputs 'input' and 'output' nor the input 'response' of a method", method_.id);
    std::string line = "{block: spectrum.local_polynomial}";
    if (!command_.period.empty()) {
      line = "{block: spectrum.averaging_dft, period: " + yaml_text(command_.period);
      if (!command_.skip.empty()) line += ", skip: " + yaml_text(command_.skip);
      line += "}";
    }
    blocks_.emplace_back("response", line);
    connections_ = {"data.input -> response.input", "data.output -> response.output", "response -> identify.response"};
    return {};
  }

  Refusal set_order() {
    if (!has(method_, "order"))
      return command_.order.empty() ? "" : fmt::format("--order: the order of a model by {} is fixed", method_.id);
    bool by_set = false;
    for (const std::string& set : command_.sets) {
      if (set.rfind("order=", 0) != 0) continue;
      by_set = true;
      if (!command_.order.empty() && set.substr(6) != command_.order)
        return fmt::format("--order {} and --set {} contradict each other; give one of them", command_.order, set);
    }
    if (command_.order.empty() && !by_set) return "--order is missing: the number of poles, or auto";
    add_setting("order", command_.order);
    return {};
  }

  void add_setting(const std::string& name, const std::string& value) {
    if (!value.empty()) settings_ += fmt::format(", {}: {}", name, yaml_text(value));
  }

  const IdentifyCommand& command_;
  const BlockDescription& method_;
  DataKind kind_;
  std::vector<std::pair<std::string, std::string>> blocks_;
  std::vector<std::string> connections_;
  std::string settings_;  // of the method, as they stand in its line
};

int refuse(const std::string& text, int code) {
  say_error(text);
  return code;
}

/// What to type next: the comparison where these were samples of one input and one output, the report otherwise.
std::string next_command(const IdentifyCommand& command, DataKind kind, const std::filesystem::path& directory) {
  const bool comparable = kind == DataKind::time_series && command.data.inputs.size() == 1 && command.data.outputs.size() == 1;
  if (!comparable) return "Next: bodeflow report " + shell_word(directory.string());
  std::string text = "Next, with other data if you have some: bodeflow compare " + shell_word(directory.string());
  text += " --data " + shell_word(command.data.file);
  for (const auto& input : command.data.inputs) text += " --input " + shell_word(input);
  for (const auto& output : command.data.outputs) text += " --output " + shell_word(output);
  if (!command.data.rate.empty()) text += " --rate " + shell_word(command.data.rate);
  return text;
}

int identify(const Session& session, const IdentifyCommand& command) {
  Registry registry = session.open_registry();
  const auto method = method_named(registry, command.method);
  if (!method) return refuse(method.error(), kUsage);
  const auto kind = data_kind(command.data, registry);
  if (!kind) return refuse(kind.error(), kRejected);
  IdentifyGraph graph(command, **method, *kind);
  if (const Refusal refusal = graph.build(); !refusal.empty()) return refuse(refusal, kUsage);
  for (const auto& set : command.sets)
    if (const Refusal refusal = graph.set(set); !refusal.empty()) return refuse(refusal, kUsage);
  if (*kind == DataKind::frequency_response && !command.data.inputs.empty())
    say_warning(command.data.file + " holds a frequency response: --input and --output name nothing in it");

  const RanGraph ran = run_one_off(session, registry, {"identify", graph.text(), graph.overrides, command.out, command.json});
  if (ran.exit_code == kDone && !command.json) fmt::print("{}\n", next_command(command, *kind, ran.directory));
  return ran.exit_code;
}

}  // namespace

void add_identify(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("identify", "Identify a model from a data file");
  auto options = std::make_shared<IdentifyCommand>();
  command->add_option("data", options->data.file, "Samples over time, or a frequency response, in a file")->required();
  add_columns_to(*command, options->data);
  command->add_option("--method", options->method, "How: a block of role 'identifier', such as maximum_likelihood")
      ->required()
      ->type_name("ID");
  command->add_option("--order", options->order, "Number of poles, or auto")->type_name("N|auto");
  command->add_option("--rate", options->data.rate, "Samples per second, where the file does not say them")->type_name("HZ");
  command->add_option("--period", options->period, "Samples in a period of a periodic excitation")->type_name("N");
  command->add_option("--skip", options->skip, "Periods at the start that hold the transient")->type_name("N");
  command->add_option("--set", options->sets, "PARAM=VALUE: a parameter of the method (bodeflow describe ID lists them)")
      ->type_name("PARAM=VALUE")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Run directory (runs/<time>-identify otherwise)")->type_name("DIR");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([&session, options] { session.action = [&session, options] { return identify(session, *options); }; });
}

}  // namespace bodeflow::tools
