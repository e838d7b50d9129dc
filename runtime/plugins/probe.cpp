#include "plugins/probe.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "plugins/child.hpp"
#include "plugins/description_json.hpp"
#include "plugins/elf_note.hpp"
#include "plugins/file_bytes.hpp"
#include "plugins/library.hpp"

namespace bodeflow {
namespace {

/// Loads the file here; nothing of it has run before its note was read.
PluginDescription describe_here(const std::filesystem::path& file) {
  PluginDescription plugin;
  const auto refuse = [&](const std::string& why) {
    plugin.refused = why;
    plugin.file = file.string();
    return plugin;
  };
  const auto bytes = file_bytes(file);
  if (!bytes) return refuse(bytes.error());
  const auto note = read_elf_note(*bytes);
  if (!note) return refuse(note.error());
  if (const std::string why = abi_problem(note->abi_major, note->abi_minor); !why.empty()) return refuse(why);
  const auto library = Library::load(file);
  if (!library) return refuse(library.error());
  plugin = (*library)->description();
  plugin.file = file.string();
  return plugin;
}

/// The process belongs to one plugin: it dies with its parent, leaves no core file, and a crash ends it by the signal itself.
void prepare_for_crashes() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  for (const int number : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}) ::signal(number, SIG_DFL);
}

/// "SIGSEGV (Segmentation fault)".
std::string signal_name(int number) {
  const char* name = sigabbrev_np(number);
  return fmt::format("SIG{} ({})", name == nullptr ? std::to_string(number) : name, strsignal(number));
}

/// ": " and the last line that is not empty, or "".
std::string last_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
  if (text.empty()) return {};
  const std::size_t begin = text.rfind('\n');
  return ": " + (begin == std::string::npos ? text : text.substr(begin + 1));
}

}  // namespace

int probe_main(const char* file) {
  prepare_for_crashes();
  const int answer = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (answer < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return 1;
  const std::string text = to_json(describe_here(file)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = ::write(answer, text.data() + at, text.size() - at);
    if (written < 0 && errno != EINTR) return 1;
    if (written > 0) at += static_cast<std::size_t>(written);
  }
  ::close(answer);
  return 0;
}

PluginDescription probe(const std::filesystem::path& file, const std::filesystem::path& command, double timeout_s) {
  if (command.empty()) return describe_here(file);
  PluginDescription plugin;
  plugin.file = file.string();
  const auto refuse = [&](const std::string& why) {
    plugin.refused = why;
    return plugin;
  };
  const auto child = run_child({command.string(), "probe-plugin", file.string()}, timeout_s);
  if (!child) return refuse("can't be probed: " + child.error());
  if (child->timed_out) return refuse(fmt::format("does not describe itself within {} s", timeout_s));
  if (child->signal != 0)
    return refuse(fmt::format("crashes while loading: {}{}", signal_name(child->signal), last_line(child->messages)));
  if (child->exit_code != 0 || child->output.empty()) {
    return refuse(
        fmt::format("ends the program while loading, with exit code {}{}", child->exit_code, last_line(child->messages)));
  }
  const auto json = nlohmann::ordered_json::parse(child->output, nullptr, false);
  auto found = plugin_from_json(json);
  if (!found) return refuse("gives a broken description: " + found.error());
  found->file = plugin.file;
  return *found;
}

}  // namespace bodeflow
