#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plugins/registry.hpp"

namespace bodeflow::tools::report {

struct ReportOptions {
  std::filesystem::path directory;  ///< the run's
  std::filesystem::path
      page;  ///< empty: report.html in it, with the drawings in `plots`; else the drawings stand in `<page>_plots`
  std::function<void(double)> progress = [](double) {};  ///< the share of the recorded streams that was read
};

struct WrittenReport {
  std::filesystem::path page;
  std::vector<std::filesystem::path> plots;
  std::string status;  ///< of the run
  std::size_t records = 0;
  std::vector<std::string> warnings;  ///< "source: text", as the page shows them
  std::vector<std::string> problems;  ///< what could not be read and is not shown
};

/// Renders the report of a run directory: one HTML file that needs nothing else, and its drawings as SVG files. A run that is
/// partial or damaged gives what can be read, with the problems named. Error: no run directory, or a file can't be written.
tl::expected<WrittenReport, std::string> write_report(const ReportOptions& options, const Registry& registry);

/// True where rendering takes a moment only (results and recordings below 64 MB).
bool is_quick(const std::filesystem::path& directory);

}  // namespace bodeflow::tools::report
