#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bodeflow::tools::exports {

/// A ZIP archive of files (name, content), stored without compression and dated 1980: equal content gives equal bytes.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace bodeflow::tools::exports
