#pragma once

#include <string>

namespace bodeflow::tools::live {

/// The page: one file that loads nothing but what this server tells of the run. Its script may run under `nonce`.
std::string page_html(const std::string& title, const std::string& nonce);

/// Its script.
const char* page_script();

}  // namespace bodeflow::tools::live
