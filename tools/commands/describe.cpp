#include <fmt/format.h>

#include <cmath>

#include "commands/command.hpp"
#include "commands/filter_response.hpp"
#include "console/json_output.hpp"
#include "plugins/description_json.hpp"

namespace bodeflow::tools {
namespace {

std::string type_name(const ParameterDescription& parameter) {
  switch (parameter.type) {
    case BF_BOOL:
      return "true or false";
    case BF_INTEGER:
      return "integer";
    case BF_NUMBER:
      return "number";
    case BF_STRING:
      return "text";
    case BF_CHOICE:
      return fmt::format("{}", fmt::join(parameter.choices, " | "));
    case BF_FILE:
      return "file";
    case BF_NUMBERS:
      return "list of numbers";
    case BF_INTEGERS:
      return "list of integers";
    case BF_STRINGS:
      return "list of texts";
    case BF_COMPLEX_LIST:
      return "list of complex numbers";
    case BF_MATRIX:
      return "matrix";
    default:
      return "value";
  }
}

std::string default_text(const ParameterDescription& parameter) {
  const ParameterValue& value = parameter.fallback;
  if (parameter.required) return "required";
  if (value.rows == 0) return "optional";
  switch (parameter.type) {
    case BF_BOOL:
      return value.integer != 0 ? "true" : "false";
    case BF_INTEGER:
      return std::to_string(value.integer);
    case BF_NUMBER:
      return fmt::format("{}", value.numbers.at(0));
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      return value.strings.at(0).empty() ? "''" : value.strings.at(0);
    case BF_NUMBERS:
      return fmt::format("[{}]", fmt::join(value.numbers, ", "));
    case BF_INTEGERS:
      return fmt::format("[{}]", fmt::join(value.integers, ", "));
    case BF_STRINGS:
      return fmt::format("[{}]", fmt::join(value.strings, ", "));
    default:
      return "given";
  }
}

std::string range_text(const ParameterDescription& parameter) {
  const bool low = std::isfinite(parameter.minimum), high = std::isfinite(parameter.maximum);
  if (!low && !high) return "";
  return fmt::format(", {}{}, {}{}", low && !parameter.exclusive_minimum ? "[" : "(",
                     low ? fmt::format("{}", parameter.minimum) : "-inf", high ? fmt::format("{}", parameter.maximum) : "inf",
                     high && !parameter.exclusive_maximum ? "]" : ")");
}

void print_ports(const BlockDescription& block) {
  for (const auto& port : block.ports) {
    const std::string kind = port.kind == BF_STREAM ? (port.element == BF_C64   ? "complex stream"
                                                       : port.element == BF_F64 ? "stream"
                                                                                : "any stream")
                                                    : "record" + (port.record_type.empty() ? "" : " " + port.record_type);
    fmt::print("  {:<4} {:<16} {}{}  {}\n", port.direction == BF_IN ? "in" : "out", port.name, kind,
               port.optional ? ", optional" : "", port.doc);
  }
}

template <class Description>
void print_head(const Description& one, const char* kind) {
  fmt::print("{}  {}{}\n", bold(one.id), dim(kind), one.summary);
  if (!one.doc.empty()) fmt::print("\n{}\n", one.doc);
}

void print_foot(const std::string& references, const PluginDescription& plugin) {
  if (!references.empty()) fmt::print("\n{}\n{}\n", bold("References"), references);
  fmt::print("\n{}\n", dim(fmt::format("plugin {} {}, {}", plugin.name, plugin.version, plugin.file)));
}

void print_parameters(const BlockDescription& block) {
  for (const auto& parameter : block.parameters) {
    fmt::print("  {:<16} {}{}{}; {}{}\n", parameter.name, type_name(parameter),
               parameter.unit.empty() ? "" : " [" + parameter.unit + "]", range_text(parameter), default_text(parameter),
               parameter.live ? "; live" : "");
    if (!parameter.doc.empty()) fmt::print("  {:<16} {}\n", "", dim(parameter.doc));
  }
}

void print(const BlockDescription& block, const PluginDescription& plugin) {
  print_head(block, "");
  fmt::print("\n{}\n", bold("Ports"));
  print_ports(block);
  if (!block.parameters.empty()) fmt::print("\n{}\n", bold("Parameters"));
  print_parameters(block);
  std::vector<std::string> traits;
  if (block.realtime_safe) traits.emplace_back("real-time safe");
  if (block.in_place) traits.emplace_back("in place");
  if (block.asynchronous) traits.emplace_back("asynchronous");
  if (!traits.empty()) fmt::print("\n{}\n", fmt::join(traits, ", "));
  print_foot(block.references, plugin);
}

void print_base_model(const BlockDescription& model, const PluginDescription& plugin) {
  print_head(model, "base model: ");
  if (!model.parameters.empty()) fmt::print("\n{}\n", bold("Declared"));
  print_parameters(model);
  print_foot(model.references, plugin);
}

/// How an effect acts, in words.
std::string acts_text(const EffectDescription& effect) {
  switch (effect.acts) {
    case Acts::law:
      return fmt::format("a law at places of kind {}", fmt::join(effect.kinds, ", "));
    case Acts::immittance:
      return fmt::format("an impedance at places of kind {}", fmt::join(effect.kinds, ", "));
    case Acts::input:
      return "on the samples of the input";
    case Acts::output:
      return "on the samples of the output";
    case Acts::series:
      return "multiplies the response";
    case Acts::parallel:
      return "adds to the response";
    case Acts::delay:
      return "a delay";
    case Acts::tone:
      return "sinusoids in the output that the input does not make";
  }
  return "";
}

void print(const EffectDescription& effect, const PluginDescription& plugin) {
  print_head(effect, "effect: ");
  fmt::print("\n  {:<16} {}\n", "acts", acts_text(effect));
  if (effect.nonstationary) fmt::print("  {:<16} on the time since the record began\n", "depends");
  if (!effect.equivalents.empty())
    fmt::print("  {:<16} {}{}\n", "acts alike", fmt::join(effect.equivalents, ", "),
               effect.separation.empty() ? "" : "; told apart by: " + effect.separation);
  print_foot(effect.references, plugin);
}

int describe(const Session& session, const std::string& id, const ConfiguredBlock& configured) {
  Registry registry = session.open_registry();
  const bool as_json = configured.json;
  const PluginDescription* plugin = registry.plugin_of(id);
  if (plugin == nullptr) {
    std::vector<std::string> all = registry.ids();
    for (const auto& more : {registry.effects(), registry.base_models()}) all.insert(all.end(), more.begin(), more.end());
    say_error(fmt::format("no block, effect or base model '{}'{}; 'bodeflow plugins' lists them", id, did_you_mean(id, all)));
    return kUsage;
  }
  if (!configured.sets.empty() || !configured.rate.empty()) {
    if (const BlockDescription* block = registry.find(id)) return print_filter_response(session, registry, *block, configured);
    say_error(fmt::format("--set and --rate go with a block, {} is none", id));
    return kUsage;
  }
  if (const EffectDescription* effect = registry.find_effect(id)) {
    as_json ? print_json(to_json(*effect)) : print(*effect, *plugin);
  } else if (const BlockDescription* model = registry.find_base_model(id)) {
    as_json ? print_json(base_model_to_json(*model)) : print_base_model(*model, *plugin);
  } else {
    as_json ? print_json(to_json(*registry.find(id))) : print(*registry.find(id), *plugin);
  }
  return kDone;
}

}  // namespace

void add_describe(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand(
      "describe", "Tell what a block, an effect or a base model is: ports, parameters with units and ranges, references");
  auto id = std::make_shared<std::string>();
  auto configured = std::make_shared<ConfiguredBlock>();
  command->add_option("id", *id, "Block, effect or base model, such as spectrum.averaging_dft")->required();
  command->add_option("--set", configured->sets, "PARAM=VALUE of a filter: tell its frequency and impulse response")
      ->allow_extra_args(false);
  command->add_option("--rate", configured->rate, "Sample rate of a filter's input, such as '10 kHz'");
  command->add_flag("--json", configured->json, "Print JSON");
  command->callback([&session, id, configured] {
    session.action = [&session, id, configured] { return describe(session, *id, *configured); };
  });
}

}  // namespace bodeflow::tools
