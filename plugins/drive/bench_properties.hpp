#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/record_view.hpp>
#include <string>

#include "records/signals.hpp"

namespace bodeflow::drive {

/// Puts the property `name` of a record `bench_properties` in place of `value`; a record without it leaves the value alone.
/// Throws Failure when the property is not a number from `least` to `most`.
inline void take_property(const RecordView& record, const char* name, double least, double most, double& value) {
  if (!record.attribute(name)) return;
  const auto found = record.number(name);
  if (!found) fail(std::string("property ") + name + " is not a number");
  if (!(*found >= least && *found <= most)) {
    fail(std::string("property ") + name + " = " + records::short_number(*found) + ", allowed: " + records::short_number(least) +
         " to " + records::short_number(most));
  }
  value = *found;
}

}  // namespace bodeflow::drive
