#include "report/report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "record/json_text.hpp"

namespace bodeflow::tools {
namespace {

struct ReportCommand {
  std::string directory;
  std::string out;
  bool json = false;
};

/// A line on a terminal while long recordings are read.
void show_progress(double share) {
  static int shown = -1;
  const int now = static_cast<int>(100.0 * share);
  if (now == shown || isatty(STDERR_FILENO) == 0) return;
  shown = now;
  if (now < 100)
    fmt::print(stderr, "\rreading recordings: {} %", now);
  else
    fmt::print(stderr, "\r\033[K");
}

int write(const Session& session, const ReportCommand& command) {
  const Registry registry = session.open_registry();
  const auto written = report::write_report({command.directory, command.out, show_progress}, registry);
  if (!written) {
    say_error(written.error());
    return kUsage;
  }
  for (const auto& problem : written->problems) say_warning(problem);
  if (!command.json) {
    fmt::print("{}\n", written->page.string());
    return kDone;
  }
  nlohmann::ordered_json plots = nlohmann::ordered_json::array();
  for (const auto& plot : written->plots) plots.push_back(plot.string());
  fmt::print("{}\n", record::json_text({{"report", written->page.string()},
                                        {"plots", plots},
                                        {"status", written->status},
                                        {"records", written->records},
                                        {"warnings", written->warnings},
                                        {"problems", written->problems}}));
  return kDone;
}

}  // namespace

void add_report(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("report", "Render the report of a run: one HTML file, and its plots as SVG files");
  auto options = std::make_shared<ReportCommand>();
  command->add_option("directory", options->directory, "The run directory")->required();
  command->add_option("--out", options->out, "The HTML file (report.html in the run directory otherwise)")->type_name("FILE");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([&session, options] { session.action = [&session, options] { return write(session, *options); }; });
}

}  // namespace bodeflow::tools
