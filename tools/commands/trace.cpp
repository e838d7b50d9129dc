#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands/data_source.hpp"
#include "commands/one_off.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

struct TraceCommand {
  std::string model, black_box;
  std::vector<std::string> fit;
  std::string select, test;
  DataOptions columns;  ///< of every file
  std::string period, skip;
  std::vector<std::string> declare, known, effects, without, sets;
  std::string out;
  bool json = false;
};

/// A file with what it is for.
struct TraceFile {
  std::string role;  ///< "fit", "select", "test"
  std::size_t given = 0;
  std::string name;  ///< "fit 1": as the tracer counts them
  std::string file;
  DataKind kind = DataKind::time_series;
  double duration_s = 0.0;

  std::string base_name() const { return fs::path(file).filename().string(); }
  /// Of its block in the graph.
  std::string block() const { return role == "fit" ? fmt::format("fit_{}", name.substr(4)) : role; }
};

/// Ends the command with a reason and an exit code.
struct Refused {
  std::string why;
  int code = kUsage;
};

std::string with_family(const std::string& id) { return id.find('.') == std::string::npos ? "residual." + id : id; }

/// What a base model takes as a black box.
std::string black_box_type(const std::string& model) {
  return with_family(model) == "residual.frequency_response" ? "frequency_response" : "model";
}

std::string listed(const std::vector<std::string>& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

/// Throws Refused where the base model is not there, or does not declare what is declared.
void check_model(const TraceCommand& command, const Registry& registry) {
  const std::string id = with_family(command.model);
  const BlockDescription* model = registry.find_base_model(id);
  const auto models = registry.base_models();
  if (model == nullptr)
    throw Refused{fmt::format("--model '{}': no such base model{}; there are: {}", command.model, did_you_mean(id, models),
                              listed(models))};
  std::vector<std::string> names;
  for (const auto& parameter : model->parameters) names.push_back(parameter.name);
  for (const std::string& declaration : command.declare) {
    const auto equal = declaration.find('=');
    if (equal == std::string::npos || equal == 0)
      throw Refused{fmt::format("--declare '{}': expected NAME=VALUE, such as computation_delay=100us", declaration)};
    const std::string name = declaration.substr(0, equal);
    if (model->parameter(name) < 0)
      throw Refused{fmt::format("--declare {}: {} declares no '{}'{}; it declares: {}", name, id, name, did_you_mean(name, names),
                                listed(names))};
  }
}

void check_effects(const TraceCommand& command, const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& id : registry.effects()) names.push_back(id.substr(id.find('.') + 1));
  for (const auto& [option, given] : {std::pair{"--effects", &command.effects}, {"--without", &command.without}}) {
    for (const auto& name : *given) {
      if (std::find(names.begin(), names.end(), name) == names.end() && registry.find_effect(name) == nullptr)
        throw Refused{
            fmt::format("{} {}: no such effect{}; there are: {}", option, name, did_you_mean(name, names), listed(names))};
    }
  }
}

/// The files, those to be fitted in the order in which their records arrive: the shorter first.
std::vector<TraceFile> files_of(const TraceCommand& command, Registry& registry) {
  std::vector<TraceFile> files;
  for (std::size_t i = 0; i < command.fit.size(); ++i) files.push_back({"fit", i + 1, "", command.fit[i]});
  if (!command.select.empty()) files.push_back({"select", 1, "select", command.select});
  if (!command.test.empty()) files.push_back({"test", 1, "test", command.test});
  for (TraceFile& file : files) {
    DataOptions options = command.columns;
    options.file = file.file;
    const auto kind = data_kind(options, registry);
    if (!kind) throw Refused{kind.error(), kRejected};
    file.kind = *kind;
    if (file.kind == DataKind::frequency_response) continue;
    const auto duration = duration_of(options, registry);
    if (!duration) throw Refused{duration.error(), kRejected};
    file.duration_s = *duration;
  }
  const auto end = files.begin() + static_cast<std::ptrdiff_t>(command.fit.size());
  std::stable_sort(files.begin(), end, [](const TraceFile& a, const TraceFile& b) { return a.duration_s < b.duration_s; });
  for (auto file = files.begin(); file != end; ++file) file->name = fmt::format("fit {}", file - files.begin() + 1);
  return files;
}

/// Throws Refused for options that belong to samples where there are none.
void check_samples(const TraceCommand& command, const std::vector<TraceFile>& files) {
  const auto response =
      std::find_if(files.begin(), files.end(), [](const auto& f) { return f.kind == DataKind::frequency_response; });
  const bool all = std::all_of(files.begin(), files.end(), [](const auto& f) { return f.kind == DataKind::frequency_response; });
  if (all) {
    for (const auto& [option, value] :
         {std::pair{"--period", command.period}, {"--skip", command.skip}, {"--rate", command.columns.rate}})
      if (!value.empty()) throw Refused{fmt::format("{}: {} holds a frequency response, not samples", option, response->file)};
    if (!command.columns.inputs.empty())
      say_warning(response->file + " holds a frequency response: --input and --output name nothing in it");
  }
  if (!command.skip.empty() && command.period.empty())
    throw Refused{"--skip counts periods: it needs --period, the samples of one"};
}

/// "fit 2: added_mass=8 g" or "low.csv: added_mass=8 g" with the record as the tracer counts it. Throws Refused.
std::string known_of(const std::string& text, const std::vector<TraceFile>& files) {
  const auto colon = text.find(": ");
  if (colon == std::string::npos || text.find('=', colon) == std::string::npos)
    throw Refused{fmt::format("--known '{}': expected 'RECORD: NAME=VALUE', such as 'fit 1: added_mass=8 g'", text)};
  const std::string record = text.substr(0, colon);
  std::vector<std::string> allowed;
  for (const TraceFile& file : files) {
    const std::string given = file.role == "fit" ? fmt::format("fit {}", file.given) : file.role;
    if (record == given || record == file.file || record == file.base_name()) return file.name + text.substr(colon);
    allowed.push_back(given);
    allowed.push_back(file.base_name());
  }
  throw Refused{
      fmt::format("--known '{}': no record '{}'{}; there are: {}", text, record, did_you_mean(record, allowed), listed(allowed))};
}

/// ", name: [...]" or "".
std::string setting(const std::string& name, const std::vector<std::string>& texts) {
  return texts.empty() ? "" : fmt::format(", {}: {}", name, yaml_text(texts));
}

std::string graph_of(const TraceCommand& command, const std::vector<TraceFile>& files) {
  std::string blocks, connections;
  for (const TraceFile& file : files) {
    DataOptions options = command.columns;
    options.file = file.file;
    const std::string name = file.block();
    blocks += fmt::format("  {}: {}\n", name, data_block(options, file.kind));
    if (file.kind == DataKind::frequency_response) {
      connections += fmt::format("  - {} -> trace.{}\n", name, file.role);
      continue;
    }
    std::string about;
    if (!command.period.empty()) about += ", period: " + yaml_text(command.period);
    if (!command.skip.empty()) about += ", skip: " + yaml_text(command.skip);
    blocks += fmt::format("  {}_record: {{block: acquisition.recording{}}}\n", name, about);
    connections += fmt::format(
        "  - {0}.input -> {0}_record.input\n  - {0}.output -> {0}_record.output\n  - {0}_record -> trace.{1}\n", name, file.role);
  }
  if (!command.black_box.empty()) {
    blocks += fmt::format("  black_box: {{block: acquisition.result, type: {}, file: {}}}\n", black_box_type(command.model),
                          yaml_text(fs::absolute(command.black_box).lexically_normal().string()));
    connections += "  - black_box -> trace.model\n";
  }
  std::vector<std::string> known;
  for (const auto& text : command.known) known.push_back(known_of(text, files));
  blocks += fmt::format("  trace: {{block: residual.trace, base: {}{}{}{}{}}}\n", yaml_text(command.model),
                        setting("declare", command.declare), setting("known", known), setting("effects", command.effects),
                        setting("without", command.without));
  std::vector<std::string> names;
  for (const TraceFile& file : files) names.push_back(file.base_name());
  return fmt::format("bodeflow: 1\ntitle: {}\nsummary: {{show: [trace]}}\nrun: {{clock: simulated}}\nblocks:\n{}connections:\n{}",
                     yaml_text(fmt::format("What does {} lack? {}", command.model, fmt::join(names, ", "))), blocks, connections);
}

/// PARAM=VALUE of the tracer as an override of the graph. Throws Refused.
std::pair<std::string, std::string> override_of(const std::string& text, const Registry& registry) {
  const auto equal = text.find('=');
  if (equal == std::string::npos || equal == 0)
    throw Refused{fmt::format("--set '{}': expected PARAM=VALUE, such as alpha=0.001", text)};
  const std::string name = text.substr(0, equal);
  const BlockDescription* tracer = registry.find("residual.trace");
  std::vector<std::string> names;
  if (tracer != nullptr)
    for (const auto& parameter : tracer->parameters) names.push_back(parameter.name);
  if (tracer == nullptr || tracer->parameter(name) < 0)
    throw Refused{fmt::format("--set {}: residual.trace has no parameter '{}'{}; it has: {}", name, name,
                              did_you_mean(name, names), listed(names))};
  return {"blocks.trace." + name, text.substr(equal + 1)};
}

int trace(const Session& session, const TraceCommand& command) {
  Registry registry = session.open_registry();
  try {
    check_model(command, registry);
    check_effects(command, registry);
    std::error_code error;
    if (!command.black_box.empty() && !fs::exists(command.black_box, error))
      throw Refused{command.black_box + ": no such run directory or result.json", kRejected};
    OneOff run{"trace", "", {}, command.out, command.json};
    for (const auto& set : command.sets) run.overrides.push_back(override_of(set, registry));
    const auto files = files_of(command, registry);
    check_samples(command, files);
    run.graph = graph_of(command, files);
    if (!command.json)
      for (const TraceFile& file : files) fmt::print("{:<7} {}\n", file.name, file.file);
    return run_one_off(session, registry, run).exit_code;
  } catch (const Refused& refused) {
    say_error(refused.why);
    return refused.code;
  }
}

}  // namespace

void add_trace(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("trace", "Name the physical effect that a declared model lacks, from data files");
  auto o = std::make_shared<TraceCommand>();
  const auto words = [&](const char* name, std::vector<std::string>& list, const char* what, const char* type) {
    return command->add_option(name, list, what)->type_name(type)->allow_extra_args(false);
  };
  command->add_option("--model", o->model, "What the plant is declared to be: a base model, such as second_order")
      ->required()
      ->type_name("ID");
  command
      ->add_option("--fit", o->fit,
                   "Records that are fitted: samples over time or frequency responses, better two of different level")
      ->required()
      ->type_name("DATA...");
  command->add_option("--select", o->select, "Record that ranks the candidates; without it a part of the others")
      ->type_name("DATA");
  command->add_option("--test", o->test, "Record for the errors before and after, used for nothing else")->type_name("DATA");
  add_columns_to(*command, o->columns);
  command->add_option("--rate", o->columns.rate, "Samples per second, where the files do not say them")->type_name("HZ");
  command->add_option("--period", o->period, "Samples in a period of a periodic excitation")->type_name("N");
  command->add_option("--skip", o->skip, "Periods at the start that hold the transient")->type_name("N");
  words("--declare", o->declare, "What the base model declares (bodeflow describe residual.ID lists it)", "NAME=VALUE");
  words("--known", o->known, "What one record states: 'fit 1: added_mass=8 g', or by the file's name", "RECORD: NAME=VALUE");
  words("--effects", o->effects, "Effects to try, separated by commas (all that plugins give otherwise)", "NAME,...")
      ->delimiter(',');
  words("--without", o->without, "Effects that are not tried", "NAME,...")->delimiter(',');
  command
      ->add_option("--black-box", o->black_box,
                   "Run directory or result.json with the model, for a base model that is a black box")
      ->type_name("RUN");
  words("--set", o->sets, "A parameter of residual.trace, such as alpha=0.001", "PARAM=VALUE");
  command->add_option("--out", o->out, "Run directory (runs/<time>-trace otherwise)")->type_name("DIR");
  command->add_flag("--json", o->json, "Print JSON");
  command->callback([&session, o] { session.action = [&session, o] { return trace(session, *o); }; });
}

}  // namespace bodeflow::tools
