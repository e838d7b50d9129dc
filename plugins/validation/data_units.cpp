#include "data_units.hpp"

#include <bodeflow/units.hpp>

namespace bodeflow::validation {
namespace {

std::string with_article(const std::string& unit) { return dimension_name(parse_unit(unit)->dimension) + " in " + unit; }

/// What numbers in the unit of the data are multiplied with to stand in the model's.
Expected<double> factor(const std::string& port, const records::Signals& data, const std::string& wanted) {
  const std::string& found = data.units.front();
  if (found.empty() || wanted.empty() || found == wanted || !parse_unit(found) || !parse_unit(wanted)) return 1.0;
  if (!same_dimension(found, wanted))
    return unexpected("its " + port + " is " + with_article(wanted) + ", '" + data.names.front() + "' of the data is " +
                      with_article(found) + "; compare with the " + port + " that it was identified from");
  const auto one = convert("1 " + found, wanted), zero = convert("0 " + found, wanted);
  if (!one || !zero) return unexpected("its " + port + ": " + (one ? zero : one).error().text);
  return *one - *zero;
}

}  // namespace

Expected<records::ModelData> in_units_of(const records::Signals& input, const records::Signals& output,
                                         records::ModelData model) {
  const auto of_input = factor("input", input, model.input_unit);
  if (!of_input) return unexpected(of_input.error().text);
  const auto of_output = factor("output", output, model.output_unit);
  if (!of_output) return unexpected(of_output.error().text);
  if (*of_input == 1.0 && *of_output == 1.0) return model;
  model.numerator *= *of_input / *of_output;
  if (model.input_amplitude) *model.input_amplitude /= *of_input;
  if (!input.units.front().empty()) model.input_unit = input.units.front();
  if (!output.units.front().empty()) model.output_unit = output.units.front();
  return model;
}

}  // namespace bodeflow::validation
