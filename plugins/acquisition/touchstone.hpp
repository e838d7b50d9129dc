#pragma once

#include "byte_source.hpp"
#include "line_reader.hpp"
#include "response.hpp"

namespace bodeflow::acquisition {

/// The network parameters in a Touchstone 1 text of `ports` ports.
///
/// Option line `# <Hz kHz MHz GHz> <S Y Z> <DB MA RI> R <ohm>`, in any order and case, each part optional (GHz S MA R 50); only
/// the first counts. A point is its frequency and ports^2 pairs: row by row, but S11 S21 S12 S22 for two ports; it begins on a
/// line of its own and may go on over any number of lines. `!` begins a comment. Y and Z are normalised to R in version 1 and
/// come back in S and ohm. The noise parameters of a two-port (frequencies that begin again) are passed over, with a remark.
/// Refused: keywords of version 2, G and H parameters, points with missing or surplus numbers, frequencies that do not rise, and
/// what `read_numbers` refuses.
/// Reference: EIA/IBIS Open Forum, Touchstone File Format Specification, Version 1.1, 2002.
Expected<ResponseTable, TextError> read_touchstone(ByteSource& source, int ports);

/// The number of ports that an ending ".s4p" tells, 1 to 99; nothing for another ending.
std::optional<int> touchstone_ports(const std::string& ending);

}  // namespace bodeflow::acquisition
