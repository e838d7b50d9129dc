#pragma once

#include <string>

#include "acquisition/number_line.hpp"
#include "acquisition/response.hpp"
#include "catch.hpp"

namespace bodeflow::test {

/// A kind of broken file, and what must be said of it.
struct BrokenResponse {
  const char* what;
  std::string text;
  const char* message;
};

/// The message for the file "F", or "read".
inline std::string message_of(const Expected<acquisition::ResponseTable, acquisition::TextError>& table) {
  return table ? "read" : acquisition::text_at("F", table.error());
}

/// Compares a complex number within 1e-12 of its magnitude.
inline void check_near(std::complex<double> found, std::complex<double> expected) {
  INFO("found " << found << ", expected " << expected);
  CHECK(std::abs(found - expected) <= 1e-12 * std::abs(expected));
}

}  // namespace bodeflow::test
