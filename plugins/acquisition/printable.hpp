#pragma once

#include <string>
#include <string_view>

namespace bodeflow::acquisition {

/// The text as a name or a message can hold it: well-formed UTF-8 in which `?` stands for each control character and for each
/// byte that is no part of a character.
std::string printable(std::string_view text);

/// The text as a message shows it: printable, in quotes, shortened.
std::string shown(std::string_view text);

}  // namespace bodeflow::acquisition
