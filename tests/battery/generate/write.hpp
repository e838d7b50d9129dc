#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generate/case.hpp"

namespace battery {

/// A record as CSV text: `u [V],y [A]`, every number 15 characters wide.
std::string csv_text(const Case& c, const CaseRecord& r);

/// What may be known of a case: rate, units, period, lines, levels.
std::string case_json(const std::string& number, const Case& c);

/// What may not be known before the answers are in.
std::string truth_json(const std::string& number, const Case& c);

/// Writes bytes to a file whose time stamp is the epoch. Throws std::runtime_error.
void write_file(const std::filesystem::path& file, const std::string& bytes);

}  // namespace battery
