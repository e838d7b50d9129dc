#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "record/files.hpp"
#include "report/front.hpp"
#include "report/limits_section.hpp"
#include "report/missing_section.hpp"
#include "report/pacing_section.hpp"
#include "report/sections.hpp"
#include "report/streams.hpp"

namespace bodeflow::tools::report {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kQuickBytes = 64U << 20U;

/// Whether a record begins with what it found, in a sentence: what warns about it follows that.
bool says_first(const Record& record) { return record.type == "trace" && !record.text("verdict").empty(); }

/// The records' places: those that the graph wants shown first, in its order, then the others as they came.
std::vector<std::size_t> order_of(const RunData& run) {
  std::vector<std::size_t> order;
  std::vector<bool> taken(run.records.size(), false);
  for (const auto& name : read_shown(run.graph_text))
    for (std::size_t n = 0; n < run.records.size(); ++n) {
      if (run.records[n].key != name || taken[n]) continue;
      taken[n] = true;
      order.push_back(n);
    }
  for (std::size_t n = 0; n < run.records.size(); ++n)
    if (!taken[n]) order.push_back(n);
  return order;
}

/// How many of the responses a record may be compared with: those before it and those of its own block, which may give the
/// response that it fitted as another output. `before`: responses before each record, and of all.
std::size_t known_to(const RunData& run, std::size_t n, const std::vector<std::size_t>& before) {
  const std::string own = run.records[n].key + ".";
  std::size_t end = n + 1;
  while (end < run.records.size() && run.records[end].key.rfind(own, 0) == 0) ++end;
  return before[end > n + 1 ? end : n];
}

void add_records(Page& page, const RunData& run) {
  std::vector<Response> responses;
  std::vector<std::size_t> before;  // responses that came before each record, and all
  for (const auto& record : run.records) {
    before.push_back(responses.size());
    if (auto response = read_response(record)) responses.push_back(std::move(*response));
  }
  before.push_back(responses.size());
  std::set<std::string> told;  // several outputs of a block often carry the same warning
  for (const std::size_t n : order_of(run)) {
    const Record& record = run.records[n];
    page.open_section(record.key, kind_of(record.type));
    for (const auto& warning : record.texts("warnings"))
      if (told.insert(warning).second && !says_first(record)) page.note(warning);
    add_record(page, record, {responses.data(), known_to(run, n, before)});
    page.close_section();
  }
  if (run.records.empty()) {
    page.open_section("Results");
    page.paragraph("The run left no records: no block of the graph sent one.");
    page.close_section();
  }
}

tl::expected<std::vector<fs::path>, std::string> write_plots(const Page& page, const fs::path& folder) {
  std::vector<fs::path> written;
  if (page.plots().empty()) return written;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return tl::unexpected(fmt::format("can't make '{}': {}", folder.string(), error.message()));
  for (const auto& plot : page.plots()) {
    const fs::path path = folder / plot.file;
    if (const auto done = record::write_atomically(path, plot.text); !done) return tl::unexpected(done.error());
    written.push_back(path);
  }
  return written;
}

}  // namespace

tl::expected<WrittenReport, std::string> write_report(const ReportOptions& options, const Registry& registry) {
  auto run = read_run(options.directory);
  if (!run) return tl::unexpected(run.error());
  Page page;
  auto warnings = warnings_of(*run);
  const bool finding_first = !run->records.empty() && says_first(run->records[order_of(*run).front()]);
  // What spoils the run stands above all.
  const auto behind = std::stable_partition(warnings.begin(), warnings.end(),
                                            [&](const Warning& warning) { return warning.bad || !finding_first; });
  add_warnings(page, {warnings.begin(), behind});
  add_missing(page, *run);
  add_records(page, *run);
  add_warnings(page, {behind, warnings.end()});
  add_streams(page, *run, options.progress);
  add_limits(page, *run);
  add_pacing(page, *run);
  add_what_was_done(page, *run, registry);
  add_provenance(page, *run);
  const Markup header = page_header(*run);
  const std::string title = run->title.empty() ? run->directory.filename().string() : run->title;

  WrittenReport written;
  written.page = options.page.empty() ? options.directory / "report.html" : options.page;
  const fs::path folder =
      options.page.empty() ? options.directory / "plots" : options.page.parent_path() / (options.page.stem().string() + "_plots");
  auto plots = write_plots(page, folder);
  if (!plots) return tl::unexpected(plots.error());
  if (const auto done = record::write_atomically(written.page, page.html(title + " – bodeflow", header)); !done)
    return tl::unexpected(done.error());
  written.plots = std::move(*plots);
  written.status = run->status;
  written.records = run->records.size();
  for (const auto& warning : warnings) written.warnings.push_back(warning.source + ": " + warning.text);
  written.problems = run->problems;
  return written;
}

bool is_quick(const fs::path& directory) {
  std::uintmax_t bytes = 0;
  for (const char* name : {"result.json", "data.h5"}) {
    std::error_code error;
    if (const auto size = fs::file_size(directory / name, error); !error) bytes += size;
  }
  return bytes <= kQuickBytes;
}

}  // namespace bodeflow::tools::report
