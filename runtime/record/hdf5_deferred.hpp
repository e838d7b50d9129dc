#pragma once

#include "record/hdf5_handle.hpp"

namespace bodeflow::record::h5 {

/// Makes a file be opened through a driver that leaves what the file held untouched until it is closed: new bytes are appended
/// as they come, changes of old bytes are kept in memory and written at the close, all or none (`write_changes`). A process that
/// is killed while objects are added so leaves the file as it was, apart from unused bytes at its end. No locks of the file:
/// readers must not be able to stop a run.
void set_deferred_driver(hid_t file_access);

}  // namespace bodeflow::record::h5
