#pragma once

#include <string>
#include <vector>

#include "report/page.hpp"
#include "report/record.hpp"

namespace bodeflow::tools::report {

struct Bar {
  std::string name;
  double value;
  int colour;
};

/// Horizontal bars with their values, from zero.
Picture draw_bars(const std::string& title, const std::vector<Bar>& bars, const std::string& unit, double width);

/// What a model leaves on the test record: by class of lines over frequency, or over time, before and after.
void add_trace_residual(Page& page, const Record& record);

/// What else shows in that residual, before and after: its mean where signals have such values, its course, its correlation with
/// itself.
void add_trace_views(Page& page, const Record& record);

/// The residual beside what is left with the remedy, all lines together.
void add_remedied_residual(Page& page, const Record& record);

}  // namespace bodeflow::tools::report
