#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <string>
#include <vector>

namespace bodeflow::acquisition {

/// One record of a result.json.
struct ResultRecord {
  std::string file;  ///< the result.json that it stands in
  std::string name;  ///< its key
  std::string run_status;
  RecordBuilder record;
};

/// The record of that name in a result.json, or in that of a run directory. Without a name: the only one there is, of that type
/// where a type is given, or of several the one called identify.
///
/// Numbers are doubles where the file writes a fraction or an exponent, else integers; null is NaN; pairs are complex numbers.
/// Errors begin with the file's name, and the place where it is no JSON, "file:line:column: what": a file that is not there or
/// has more than 1 GiB, no results of bodeflow, no such record (with those there are), a record of another type, parts of it that
/// are no record.
Expected<ResultRecord> read_result(const std::string& path, const std::string& name, const std::string& type);

}  // namespace bodeflow::acquisition
