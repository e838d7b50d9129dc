#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bodeflow::test {

/// Chromium's command where it is installed, "" otherwise.
std::string browser();

/// What a browser of that window width finds in a page: a script measures a copy of it.
///   "page_width", "window_width": a page wider than the window scrolls sideways
///   "bad_numbers": attributes of drawings with something else than finite numbers
///   "texts": of all drawings that are shown; "outside": those beyond their drawing's border, "overlapping": pairs on each other
///   "ground", "ink": colours of the page; "active": elements that load or run something
/// Null, with the reason in "error", where the browser gave none.
nlohmann::json measured(const std::filesystem::path& page, int width, bool dark);

/// What the browser's console says while it shows the page itself.
std::vector<std::string> console_lines(const std::filesystem::path& page);

/// The page as PDF.
std::string printed(const std::filesystem::path& page);

}  // namespace bodeflow::test
