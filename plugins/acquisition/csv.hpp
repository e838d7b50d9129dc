#pragma once

#include <memory>

#include "byte_source.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {

/// A reader of a CSV text; the file is opened and its header read.
///
/// Form: one header line with a name for each column, `name [unit]`, `name (unit)` or `name_unit`, then one line of numbers per
/// sample. Separator `;`, tab or `,`, the first of these that stands in the header; with `;` and tab a decimal comma is read too.
/// Lines end with LF or CRLF. Passed over: a UTF-8 byte order mark, lines that begin with `#`, empty lines before the first
/// row and after the last, blanks around fields, one separator at the end of a line. Fields may stand in quotes.
/// Refused with "file:line:column: what": all else, see README.md. Columns that are not selected may hold anything.
/// Values that are not finite are refused here, by their text.
///
/// `name` is the file's name in messages.
Expected<std::unique_ptr<TableReader>> open_csv(std::unique_ptr<ByteSource> source, const std::string& name);

}  // namespace bodeflow::acquisition
