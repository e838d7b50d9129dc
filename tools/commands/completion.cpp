#include <fmt/format.h>

#include "commands/command.hpp"

namespace bodeflow::tools {
namespace {

struct Words {
  std::string name;
  std::string help;
  std::vector<std::string> options;
};

/// The commands that people type, with their options, read from the application itself.
std::vector<Words> commands_of(const CLI::App& app) {
  std::vector<Words> all;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    Words words{command->get_name(), command->get_description(), {}};
    for (const CLI::Option* option : command->get_options())
      for (const auto& name : option->get_lnames()) words.options.push_back("--" + name);
    all.push_back(std::move(words));
  }
  return all;
}

std::string names_of(const std::vector<Words>& commands) {
  std::string names;
  for (const auto& command : commands) names += (names.empty() ? "" : " ") + command.name;
  return names;
}

std::string bash_script(const std::vector<Words>& commands) {
  std::string text =
      "_bodeflow() {\n  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]}\n  COMPREPLY=()\n  if [ \"$COMP_CWORD\" "
      "-eq 1 ]; then\n";
  text += fmt::format("    COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))\n    return\n  fi\n  case $command in\n",
                      names_of(commands));
  for (const auto& command : commands)
    text += fmt::format("    {}) [[ $word == -* ]] && COMPREPLY=($(compgen -W \"{}\" -- \"$word\")) ;;\n", command.name,
                        fmt::join(command.options, " "));
  text += "  esac\n  if [ \"$command\" = describe ] && [[ $word != -* ]]; then\n";
  text +=
      "    COMPREPLY=($(compgen -W \"$(bodeflow plugins 2>/dev/null | awk '/^  /{print $1}')\" -- \"$word\"))\n    return\n  "
      "fi\n";
  text += "  [ ${#COMPREPLY[@]} -eq 0 ] && [[ $word != -* ]] && COMPREPLY=($(compgen -f -- \"$word\"))\n}\n";
  return text + "complete -o filenames -F _bodeflow bodeflow\n";
}

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) text.replace(at, 1, "'\\''");
  for (std::size_t at = 0; (at = text.find(':', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\:");
  return text;
}

std::string zsh_script(const std::vector<Words>& commands) {
  std::string text = "#compdef bodeflow\n_bodeflow() {\n  local -a commands\n  commands=(\n";
  for (const auto& command : commands) text += fmt::format("    '{}:{}'\n", command.name, quoted(command.help));
  text += "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n  case $words[2] in\n";
  text += "    describe) compadd -- $(bodeflow plugins 2>/dev/null | awk '/^  /{print $1}') ;;\n  esac\n  case $words[2] in\n";
  for (const auto& command : commands)
    text += fmt::format("    {}) [[ $words[CURRENT] == -* ]] && compadd -- {} || _files ;;\n", command.name,
                        fmt::join(command.options, " "));
  return text + "  esac\n}\ncompdef _bodeflow bodeflow\n";
}

std::string fish_script(const std::vector<Words>& commands) {
  std::string text;
  for (const auto& command : commands) {
    std::string help = command.help;
    for (std::size_t at = 0; (at = help.find('\'', at)) != std::string::npos; at += 2) help.replace(at, 1, "\\'");
    text += fmt::format("complete -c bodeflow -n __fish_use_subcommand -f -a {} -d '{}'\n", command.name, help);
    for (const auto& option : command.options)
      text += fmt::format("complete -c bodeflow -n '__fish_seen_subcommand_from {}' -l {}\n", command.name, option.substr(2));
  }
  return text +
         "complete -c bodeflow -n '__fish_seen_subcommand_from describe' -f -a \"(bodeflow plugins 2>/dev/null | awk '/^  "
         "/{print \\$1}')\"\n";
}

}  // namespace

void add_completion(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("completion", "Print the completion script of a shell: source <(bodeflow completion bash)");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([&app, &session, shell] {
    session.action = [&app, shell]() -> int {
      const auto commands = commands_of(app);
      fmt::print("{}", *shell == "bash" ? bash_script(commands) : *shell == "zsh" ? zsh_script(commands) : fish_script(commands));
      return kDone;
    };
  });
}

}  // namespace bodeflow::tools
