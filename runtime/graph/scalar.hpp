#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "graph/node.hpp"

namespace bodeflow::graph {

/// A finite number in `unit` ("10 kHz" in "Hz" is 10000; a bare number is in the unit already). Error: what was found and what
/// is allowed.
tl::expected<double, std::string> number_of(std::string_view text, const std::string& unit);

/// A whole number without unit.
tl::expected<std::int64_t, std::string> integer_of(std::string_view text);

/// "-2+3j", "3j", "-2": real and imaginary part.
tl::expected<std::complex<double>, std::string> complex_of(std::string_view text, const std::string& unit);

tl::expected<bool, std::string> boolean_of(std::string_view text);

/// The same from nodes. Nothing: reported as "where: reason", silent about a node that is broken.
std::optional<double> read_number(const Node& node, const std::string& where, const std::string& unit, Report& report);
std::optional<std::int64_t> read_integer(const Node& node, const std::string& where, std::int64_t least, std::int64_t most,
                                         Report& report);
std::optional<std::string> read_text(const Node& node, const std::string& where, Report& report);
/// A text that is one of the choices.
std::optional<std::string> read_choice(const Node& node, const std::string& where, const std::vector<std::string>& choices,
                                       Report& report);

}  // namespace bodeflow::graph
