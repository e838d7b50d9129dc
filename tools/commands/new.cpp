#include <fmt/format.h>

#include <fstream>
#include <regex>

#include "commands/command.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

/// The folder of the template: beside the executable, in a build tree and in an installation alike.
fs::path template_folder(const Session& session) {
  return session.executable.parent_path().parent_path() / "share" / "bodeflow" / "template";
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += by.size()) text.replace(at, word.size(), by);
  return text;
}

void copy_file(const fs::path& from, const fs::path& to, const std::string& name) {
  std::ifstream in(from, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::ofstream out(to, std::ios::binary);
  out << replaced(text, "@NAME@", name);
  out.close();
  if (!in || !out) throw std::runtime_error(fmt::format("can't write '{}'", to.string()));
}

int new_plugin(const Session& session, const std::string& name) {
  if (!std::regex_match(name, std::regex("[a-z][a-z0-9_]*"))) {
    say_error(fmt::format("plugin name '{}': allowed are lower-case letters, digits and _, a letter first", name));
    return kUsage;
  }
  const fs::path source = template_folder(session), target = name;
  if (!fs::is_directory(source)) {
    say_error(fmt::format("the template is not installed: there is no '{}'", source.string()));
    return kRunFailed;
  }
  if (fs::exists(target)) {
    say_error(fmt::format("'{}' exists already", name));
    return kUsage;
  }
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    const fs::path to = target / replaced(fs::relative(entry.path(), source).string(), "@NAME@", name);
    if (entry.is_directory()) {
      fs::create_directories(to);
    } else {
      fs::create_directories(to.parent_path());
      copy_file(entry.path(), to, name);
    }
  }
  const fs::path prefix = session.executable.parent_path().parent_path();
  fmt::print(
      "Made {}/. Next:\n  cd {}\n  cmake -B build -DCMAKE_PREFIX_PATH={}\n  cmake --build build\n  ctest --test-dir build "
      "--output-on-failure\n",
      name, name, prefix.string());
  fmt::print("  bodeflow --path build run example.yaml\n");
  return kDone;
}

}  // namespace

void add_new(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("new", "Begin something of your own: new plugin NAME");
  command->require_subcommand(1);
  auto* plugin =
      command->add_subcommand("plugin", "A folder with a plugin that builds against the SDK, with its tests and a graph");
  auto name = std::make_shared<std::string>();
  plugin->add_option("name", *name, "Name of the plugin and its folder")->required();
  plugin->callback([&session, name] { session.action = [&session, name] { return new_plugin(session, *name); }; });
}

}  // namespace bodeflow::tools
