#pragma once

#include "plugins/registry.hpp"
#include "report/page.hpp"
#include "report/run_data.hpp"

namespace bodeflow::tools::report {

/// Title, status and the main facts, for the head of the page.
Markup page_header(const RunData& run);

/// A warning, and whose it is.
struct Warning {
  std::string source;
  std::string text;
  bool bad = false;  ///< ended the run, or something can't be shown
};

/// What spoils results: why the run ended early, warnings of all records, warnings and errors of the log, what could not be read.
std::vector<Warning> warnings_of(const RunData& run);
void add_warnings(Page& page, const std::vector<Warning>& warnings);

/// What was done: the drawing of each phase (where its plugins are there to tell the ports), blocks with their given parameters.
void add_what_was_done(Page& page, const RunData& run, const Registry& registry);

/// Versions, plugins with their hashes, host, inputs with checksums, events, log, and the command that repeats the run.
void add_provenance(Page& page, const RunData& run);

}  // namespace bodeflow::tools::report
