#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "records/recording.hpp"
#include "records/response.hpp"
#include "trace/trace.hpp"

namespace bodeflow::residual {

/// A record as it arrived.
using Given = std::variant<records::Recording, records::ResponseData>;

/// Records with what each is for.
struct GivenRecords {
  std::vector<Given> fit;
  std::optional<Given> select, test;
  std::vector<std::string> notes;  ///< how records were split, in sentences
};

/// How recordings are looked at.
enum class Engine { automatic, periodic, sampled };
/// Which it is for these records: periodic where all repeat a period two times or more.
Engine engine_for(const GivenRecords& records, Engine wished);

/// The records with `select` and `test`, taken from those at `fit` where they are absent: whole records from the end of the list
/// while two at least remain, else parts of the last one (whole periods of a periodic one, a quarter of another one each, bands
/// of a response). Of a record over time with more than 131072 samples, the one at `test` apart, the middle is taken. Errors: a
/// record too short to be split, with how much it would need.
Expected<GivenRecords> with_all_parts(GivenRecords records, Engine engine);

/// The records as measurements, "fit 1", "fit 2" ..., "select", "test". `known`: "record: name=value unit". Throws Failure for a
/// statement that is wrong. Segments: of records over time, see SampledOptions; the test record has its own. Errors: those of the
/// measurements, with the record's name; a recording whose units, where they are given, are not those of the base model.
Expected<TraceData> measurements_of(const GivenRecords& records, Engine engine, const BaseModel& base,
                                    const std::vector<std::string>& known, double segment_s = 0.0, double test_segment_s = 0.0);

}  // namespace bodeflow::residual
