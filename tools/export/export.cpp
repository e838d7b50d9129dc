#include "export/export.hpp"

#include <fmt/format.h>

#include "export/fmu.hpp"
#include "export/mat_file.hpp"
#include "export/matlab_script.hpp"

namespace bodeflow::tools::exports {
namespace {

Result<std::string> content_of(const ModelFile& file, const std::string& format) {
  if (format == "json") return json_of(file);
  if (format == "matlab") return matlab_of(file);
  if (format == "mat") return mat_of(file);
  if (format == "python") return python_of(file);
  return fmu_of(file);
}

}  // namespace

const char* ending_of(const std::string& format) {
  if (format == "matlab") return ".m";
  if (format == "python") return ".py";
  return format == "json" ? ".json" : format == "mat" ? ".mat" : ".fmu";
}

tl::expected<Exported, std::string> exported(const Request& request) {
  auto file = read_model_file(request.model, request.key);
  if (!file) return refused(file.error());
  file->name = request.name.empty() ? identifier_of(file->name) : request.name;
  auto content = content_of(*file, request.format);
  if (!content) return refused(request.model + ": " + content.error());
  const auto& s = file->system();
  return Exported{file->name, std::move(*content),
                  fmt::format("{} states, {} inputs, {} outputs, {}", s.states(), s.inputs(), s.outputs(),
                              s.sample_time > 0.0 ? fmt::format("sample time {:g} s", s.sample_time) : "continuous in time")};
}

}  // namespace bodeflow::tools::exports
