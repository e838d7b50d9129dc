#include "export/record_text.hpp"

#include "record/json_text.hpp"
#include "record/run_directory.hpp"

namespace bodeflow::tools::exports {

std::string json_of_record(const std::vector<std::uint8_t>& bytes) {
  return record::json_text(record::to_json(SharedRecord::copy(bytes.data(), bytes.size())));
}

}  // namespace bodeflow::tools::exports
