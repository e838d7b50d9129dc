#include "bench_properties.hpp"

#include <cmath>
#include <records/signals.hpp>
#include <string>

namespace bodeflow::drive {

void take_property(const RecordView& record, std::string_view name, const PropertyRange& range, double& value) {
  if (!record.attribute(name)) return;
  const std::optional<double> found = record.number(name);
  const std::string place = "bench_properties: " + std::string(name);
  if (!found) fail(place + " is not a number");
  if (std::isfinite(*found) && *found >= range.least && *found <= range.greatest) {
    value = *found;
    return;
  }
  fail(place + " is " + records::short_number(*found) + ", allowed: " + records::short_number(range.least) + " to " +
       records::short_number(range.greatest));
}

void check_properties(const RecordView& record, std::uint64_t position) {
  if (record.type() != kBenchProperties) {
    fail("properties: a record '" + std::string(record.type()) + "' arrived, allowed: " + kBenchProperties);
  }
  if (position > 0) {
    fail("properties: a record arrived before sample " + std::to_string(position) + ", allowed: before the first");
  }
}

}  // namespace bodeflow::drive
