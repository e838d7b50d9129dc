#include "export/fmu.hpp"

#include <fmt/format.h>

#include <cctype>

#include "export/fmu_program.hpp"
#include "export/zip.hpp"
#include "records/checksum.hpp"

namespace bodeflow::tools::exports {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

std::string rows_of(const Eigen::MatrixXd& m) {
  std::string text;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) text += fmt::format("{}{:.17g}", j == 0 ? "" : " ", m(i, j));
    text += "\n";
  }
  return text;
}

std::string system_text(const numerics::StateSpace& s) {
  return fmt::format("bodeflow-linear-system 1\n{:.17g} {} {} {}\n", s.sample_time, s.states(), s.inputs(), s.outputs()) +
         rows_of(s.A) + rows_of(s.B) + rows_of(s.C) + rows_of(s.D);
}

/// Digits that change with the system: an importer takes units with equal ones for the same.
std::string guid_of(const std::string& system) {
  std::vector<double> codes(system.begin(), system.end());
  records::Checksum forward, backward;
  forward.add(codes);
  backward.add(std::vector<double>(codes.rbegin(), codes.rend()));
  const std::string digits = forward.text() + backward.text();
  return fmt::format("{{{}-{}-{}-{}-{}}}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 4), digits.substr(16, 4),
                     digits.substr(20, 12));
}

/// Signal names as variable names: each differs from all others.
std::vector<std::string> variable_names(const ModelFile& file) {
  std::vector<std::string> names = file.input_names();
  const auto outputs = file.output_names();
  names.insert(names.end(), outputs.begin(), outputs.end());
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t before = 0; before < i; ++before)
      if (names[before] == names[i]) {
        names[i] += fmt::format("_{}", i + 1);
        before = static_cast<std::size_t>(-1);
      }
  return names;
}

std::string description(const ModelFile& file, const std::string& identifier, const std::string& guid) {
  const auto inputs = static_cast<std::size_t>(file.system().inputs()),
             outputs = static_cast<std::size_t>(file.system().outputs());
  const auto names = variable_names(file);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  xml += fmt::format(
      "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{}\" guid=\"{}\" generationTool=\"bodeflow\" "
      "variableNamingConvention=\"flat\" numberOfEventIndicators=\"0\">\n",
      escaped(file.name), guid);
  xml += fmt::format(
      "  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" "
      "canGetAndSetFMUstate=\"true\">\n    <SourceFiles>\n      <File name=\"linear_system.c\"/>\n    </SourceFiles>\n"
      "  </CoSimulation>\n  <ModelVariables>\n",
      identifier);
  for (std::size_t i = 0; i < inputs + outputs; ++i) {
    const bool input = i < inputs;
    xml += fmt::format("    <ScalarVariable name=\"{}\" valueReference=\"{}\" causality=\"{}\" variability=\"continuous\"{}>\n",
                       escaped(names[i]), i, input ? "input" : "output", input ? "" : " initial=\"calculated\"");
    xml += fmt::format("      <Real{}/>\n    </ScalarVariable>\n", input ? " start=\"0\"" : "");
  }
  xml += "  </ModelVariables>\n  <ModelStructure>\n";
  for (const char* list : {"Outputs", "InitialUnknowns"}) {
    xml += fmt::format("    <{}>\n", list);
    for (std::size_t i = 0; i < outputs; ++i) xml += fmt::format("      <Unknown index=\"{}\"/>\n", inputs + i + 1);
    xml += fmt::format("    </{}>\n", list);
  }
  return xml + "  </ModelStructure>\n</fmiModelDescription>\n";
}

}  // namespace

std::string identifier_of(const std::string& name) {
  std::string id;
  for (const char c : name) id += std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<signed char>(c) > 0 ? c : '_';
  if (id.empty() || std::isalpha(static_cast<unsigned char>(id.front())) == 0) id = "model_" + id;
  return id;
}

Result<std::string> fmu_of(const ModelFile& file) {
  if (file.model.delay_s > 0.0)
    return refused(
        fmt::format("the model has a delay of {:g} s, which the unit does not play: delay its output in the simulation, or "
                    "export another format",
                    file.model.delay_s));
  const std::string identifier = identifier_of(file.name), system = system_text(file.system());
  return zip_of({{"modelDescription.xml", description(file, identifier, guid_of(system))},
                 {"resources/system.txt", system},
                 {fmt::format("binaries/{}/{}.so", fmu_platform(), identifier), std::string(fmu_library())},
                 {"sources/linear_system.c", std::string(fmu_source())}});
}

}  // namespace bodeflow::tools::exports
