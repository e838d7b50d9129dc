#include "export/export.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "commands/command.hpp"
#include "record/files.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

struct ExportCommand {
  std::string model;
  std::string key;
  std::string format;
  std::string out;
  bool force = false;
};

int refuse(const std::string& text, int code) {
  say_error(text);
  return code;
}

int export_model(const ExportCommand& command) {
  std::error_code error;
  if (!fs::exists(command.model, error)) return refuse(command.model + ": no such file or run directory", kRejected);
  const std::string ending = exports::ending_of(command.format);
  if (!command.out.empty() && fs::path(command.out).extension() != ending)
    return refuse(fmt::format("--out {}: a file of --to {} ends in {}", command.out, command.format, ending), kUsage);
  const auto made = exports::exported({command.model, command.key, command.format, fs::path(command.out).stem().string()});
  if (!made) return refuse(made.error(), kRejected);
  const fs::path out = command.out.empty() ? fs::path(made->name + ending) : fs::path(command.out);
  if (fs::exists(out, error) && !command.force) return refuse(out.string() + ": exists already; --force replaces it", kRejected);
  if (const auto written = record::write_atomically(out, made->content); !written) return refuse(written.error(), kRejected);
  fmt::print("{}: {}\n", out.string(), made->summary);
  return kDone;
}

}  // namespace

void add_export(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("export", "Write a model for another program, or bring one back");
  auto options = std::make_shared<ExportCommand>();
  command->add_option("model", options->model, "A run directory, a result.json, or a .mat or .m file with A, B, C, D")
      ->required()
      ->type_name("MODEL");
  command
      ->add_option(
          "--to", options->format,
          "json (as result.json: other commands take it), matlab (script), mat (v5), python, fmu (FMI 2.0, co-simulation)")
      ->required()
      ->check(CLI::IsMember({"json", "matlab", "mat", "python", "fmu"}))
      ->type_name("FORMAT");
  command->add_option("--model", options->key, "Name of the model in its results (identify otherwise, or the only one)")
      ->type_name("NAME");
  command->add_option("--out", options->out, "The file (the model's name here otherwise)")->type_name("FILE");
  command->add_flag("--force", options->force, "Replace a file that exists");
  command->callback([&session, options] { session.action = [options] { return export_model(*options); }; });
}

}  // namespace bodeflow::tools
