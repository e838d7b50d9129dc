#include "live/fragments.hpp"

#include <fmt/format.h>

#include "report/graph_drawing.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::live {
namespace {

/// Beyond it a drawing takes longer than people look at it.
constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

}  // namespace

std::string graph_fragment(const graph::Phase& phase) {
  report::Page page;
  const auto wide = report::draw_phase(phase, report::kWide, true), narrow = report::draw_phase(phase, report::kNarrow, true);
  if (wide && narrow)
    page.drawing(*wide, *narrow, "graph", "Streams are solid, records dashed");
  else
    page.paragraph(fmt::format("{} blocks: too many for a drawing; their connections stand below.", phase.blocks.size()));
  return page.body().str();
}

std::string record_fragment(const std::string& key, const SharedRecord& record) {
  report::Page page;
  if (record.size() > kMostBytes) {
    page.paragraph(fmt::format("{} MB: shown by the report, when the run has ended.", record.size() >> 20U));
    return page.body().str();
  }
  const report::Record read = report::record_of(key, RecordView(*record.c()));
  for (const auto& warning : read.texts("warnings")) page.note(warning);
  if (read.type != "frequency_response" || !report::add_bode_plots(page, read)) report::add_record(page, read, {});
  return page.body().str();
}

}  // namespace bodeflow::tools::live
