#pragma once

#include <string>

namespace bodeflow::tools::report {

/// The style rules of the whole page: light and dark as the reader's system is set, wide, narrow, and on paper.
std::string page_style();

}  // namespace bodeflow::tools::report
