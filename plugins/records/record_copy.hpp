#pragma once

#include <bodeflow/record.hpp>

namespace bodeflow::records {

/// A record with the attributes and arrays of another, to be completed: attributes can be replaced, arrays added.
RecordBuilder copy_of(const RecordView& record);

}  // namespace bodeflow::records
