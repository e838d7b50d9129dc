#include <csignal>
#include <cstdio>
#include <exception>

#include "commands/command.hpp"

int main(int argc, char** argv) {
  using namespace bodeflow::tools;
  std::signal(SIGCHLD, SIG_DFL);  // whoever started us may ignore it; we wait for our children
  std::signal(SIGPIPE, SIG_IGN);  // a reader of our messages that goes away does not end a run
  Session session;
  std::error_code error;
  session.executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) session.executable = argv[0];

  CLI::App app("bodeflow: identify and control real plants in the frequency domain", "bodeflow");
  app.set_version_flag("--version", "bodeflow " BODEFLOW_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option("--path", session.plugin_path, "A folder with plugins, before the usual ones")
      ->check(CLI::ExistingPath)
      ->type_name("DIR")
      ->allow_extra_args(false);
  add_run(app, session);
  add_identify(app, session);
  add_compare(app, session);
  add_trace(app, session);
  add_check(app, session);
  add_plan(app, session);
  add_graph(app, session);
  add_expand(app, session);
  add_plugins(app, session);
  add_describe(app, session);
  add_schema(app, session);
  add_new(app, session);
  add_test_plugin(app, session);
  add_rerun(app, session);
  add_report(app, session);
  add_export(app, session);
  add_agent(app, session);
  add_hosts(app, session);
  add_top(app, session);
  add_trust(app, session);
  add_doctor(app, session);
  add_completion(app, session);
  add_internal(app, session);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& parse_error) {
    return app.exit(parse_error) == 0 ? kDone : kUsage;
  }
  try {
    const int code = session.action();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    say_error("can't write to standard output");
    return code == kDone ? kRunFailed : code;
  } catch (const std::exception& exception) {
    say_error(exception.what());
    return kRunFailed;
  }
}
