#pragma once

#include "byte_source.hpp"
#include "line_reader.hpp"
#include "response.hpp"

namespace bodeflow::acquisition {

/// What the second column of a loudspeaker data file holds.
enum class LoudspeakerFile {
  frd,  ///< magnitude in dB
  zma,  ///< magnitude in ohm
};

/// The response in a .frd or .zma text: frequency [Hz], magnitude, phase [deg] on each line, of one output and input.
///
/// Numbers stand between blanks, tabs, semicolons or commas. Three words with a comma inside and no point in the first line of
/// numbers mean decimal commas for the whole file: `10,5 80,1 -20,3`. Lines that begin with one of * # ; ! " / % are
/// comments; lines of words before the first point are passed over as well, and told. A magnitude in dB is 20 log10 of the
/// value in the unit that the user states.
/// Refused: lines with other than three numbers (two: no phase), text behind the first point, negative impedances, and what
/// `read_numbers` and FrequencyAxis refuse.
Expected<ResponseTable, TextError> read_loudspeaker_file(ByteSource& source, LoudspeakerFile kind);

}  // namespace bodeflow::acquisition
