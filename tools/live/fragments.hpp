#pragma once

#include <string>

#include "observe/watch.hpp"

namespace bodeflow::tools::live {

/// The drawing of a phase, as HTML in two widths, with room for what each block does.
std::string graph_fragment(const graph::Phase& phase);

/// A record as the report shows it, as HTML; of frequency responses the Bode plots alone.
std::string record_fragment(const std::string& key, const SharedRecord& record);

}  // namespace bodeflow::tools::live
