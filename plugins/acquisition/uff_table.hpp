#pragma once

#include <memory>

#include "byte_source.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {

/// A reader of the time functions of a universal file (data set 58 and 58b). Function k is the column "f<k>", named by its
/// response, such as "12+Z". Its rate is the inverse of the abscissa's increment. Functions over another abscissa than time,
/// complex ones and ones with uneven spacing are no columns.
Expected<std::unique_ptr<TableReader>> open_uff(OpenSource open, const std::string& name);

}  // namespace bodeflow::acquisition
