// bodeflow-conformance PLUGIN.so [--settings FILE] [--block ID] [--all] [--in-process]
#include <bodeflow/testing/conformance.hpp>
#include <cstdio>
#include <cstring>
#include <string>

int main(int count, char** arguments) {
  bodeflow::testing::Options options;
  std::string file;
  bool all = false;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool has_value = i + 1 < count;
    if (argument == "--settings" && has_value) {
      auto settings = bodeflow::testing::read_settings(arguments[++i]);
      if (!settings) {
        std::fprintf(stderr, "%s\n", settings.error().text.c_str());
        return 2;
      }
      options.settings = *settings;
    } else if (argument == "--block" && has_value) {
      options.block = arguments[++i];
    } else if (argument == "--all") {
      all = true;
    } else if (argument == "--in-process") {
      options.isolate = false;
    } else if (argument[0] != '-' && file.empty()) {
      file = argument;
    } else {
      std::fprintf(stderr, "unknown argument '%s'\n", argument.c_str());
      return 2;
    }
  }
  if (file.empty()) {
    std::fprintf(stderr, "usage: bodeflow-conformance PLUGIN.so [--settings FILE] [--block ID] [--all] [--in-process]\n");
    return 2;
  }
  const auto report = bodeflow::testing::check_plugin(file, options);
  std::fputs(bodeflow::testing::to_text(report, all).c_str(), stdout);
  return report.passed() ? 0 : 4;
}
