#include "uff_response.hpp"

#include <array>
#include <bodeflow/units.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "csv_row.hpp"
#include "number_line.hpp"
#include "response_axis.hpp"
#include "sampling.hpp"
#include "table.hpp"
#include "uff58_values.hpp"

namespace bodeflow::acquisition {
namespace {

// Codes of the format.
constexpr int kFrequencyResponse = 4;
constexpr int kAcceleration = 12;
constexpr int kFrequency = 18;

/// How a function type is called.
std::string name_of(int kind) {
  static constexpr std::array<const char*, 13> kNames = {
      "general function",        "time response",       "auto spectrum",    "cross spectrum",    "frequency response function",
      "transmissibility",        "coherence",           "auto correlation", "cross correlation", "power spectral density",
      "energy spectral density", "probability density", "spectrum"};
  if (kind >= 0 && kind < static_cast<int>(kNames.size())) return kNames[static_cast<std::size_t>(kind)];
  return "function of type " + std::to_string(kind);
}

/// The unit of output over input; "" where the labels don't tell.
std::string unit_of(const Uff58Function& f) {
  const std::string above = f.ordinate_type == kAcceleration && f.ordinate_unit == "g" ? "gn" : f.ordinate_unit;
  if (!is_unit(above) || !is_unit(f.reference_unit)) return "";
  const bool simple = f.reference_unit.find_first_of("/* ") == std::string::npos;
  std::string unit = above + "/" + (simple ? f.reference_unit : "(" + f.reference_unit + ")");
  return is_unit(unit) ? unit : "";
}

/// Hz per unit of the abscissa; without a unit it counts in Hz.
Expected<double, TextError> hz_of(const Uff58Function& f) {
  if (f.abscissa_unit.empty()) return 1.0;
  if (const auto hz = convert("1 " + f.abscissa_unit, "Hz")) return *hz;
  if (const auto radians = convert("1 " + f.abscissa_unit, "rad/s")) return *radians / (2 * std::numbers::pi);
  return refused_at(f.line, 0, "the function that begins here has frequencies in " + shown(f.abscissa_unit) + "; Hz or rad/s");
}

std::string range_of(const std::vector<double>& f) {
  return counted(f.size(), "point") + " from " + short_text(f.front()) + " to " + short_text(f.back()) + " Hz";
}

/// Reads the values of one function.
class FunctionReader {
 public:
  FunctionReader(ByteSource& source, const Uff58Function& f) : f_(f), values_(source, f) {}

  Expected<void, TextError> read() {
    const std::string what = "the function that begins here has ";
    if (!f_.complex) return refused_at(f_.line, 0, what + "real values; a frequency response is complex (data type 5 or 6)");
    if (f_.abscissa_type != kFrequency && f_.abscissa_type != 0) {
      return refused_at(
          f_.line, 0,
          what + "an abscissa of type " + std::to_string(f_.abscissa_type) + "; of a frequency response 18 (frequency)");
    }
    const auto hz = hz_of(f_);
    if (!hz) return Unexpected<TextError>{hz.error()};
    if (auto done = values_.start(0); !done) return done;
    for (std::int64_t k = 0; k < f_.points; ++k) {
      double written = f_.start + static_cast<double>(k) * f_.step;
      if (!f_.even) {
        const auto own = next();
        if (!own) return Unexpected<TextError>{own.error()};
        written = *own;
      }
      const auto re = next(), im = re ? next() : re;
      if (!im) return Unexpected<TextError>{im.error()};
      if (!std::isfinite(written * *hz)) return refused_at(place(), 0, "a frequency is not finite");
      if (auto done = axis.add(written * *hz, place(), 0); !done) return done;
      value.emplace_back(*re, *im);
    }
    return {};
  }

  FrequencyAxis axis;
  std::vector<std::complex<double>> value;

 private:
  Expected<double, TextError> next() {
    auto number = values_.next();
    if (number && !std::isfinite(*number))
      return refused_at(place(), 0, std::string("value ") + (std::isnan(*number) ? "nan" : "inf") + " is not finite");
    return number;
  }
  std::int64_t place() const { return values_.line() > 0 ? values_.line() : f_.line; }

  const Uff58Function& f_;
  Uff58Values values_;
};

/// Appends what one function says to the table.
Expected<void, TextError> add(ByteSource& source, const Uff58Function& f, std::int64_t first_line, ResponseTable& table) {
  FunctionReader reader(source, f);
  if (auto done = reader.read(); !done) return done;
  if (table.elements.empty()) {
    table.frequency_hz = reader.axis.take();
  } else if (reader.axis.values() != table.frequency_hz) {
    return refused_at(f.line, 0,
                      "the function that begins here has other frequencies, " + range_of(reader.axis.values()) +
                          ", than the one of line " + std::to_string(first_line) + ", " + range_of(table.frequency_hz));
  }
  if ((table.elements.size() + 1) * table.frequency_hz.size() > kMostResponseValues)
    return refused_at(f.line, 0, "more than 33554432 values");
  ResponseElement element;
  element.output = degree_of_freedom(f.response_node, f.response_direction);
  element.input = degree_of_freedom(f.reference_node, f.reference_direction);
  element.quantity = element.output + "/" + element.input;
  element.unit = unit_of(f);
  element.value = std::move(reader.value);
  table.elements.push_back(std::move(element));
  return {};
}

}  // namespace

Expected<ResponseTable, TextError> read_uff_response(ByteSource& source) {
  LineReader lines(source);
  const auto file = read_uff58(lines);
  if (!file) return Unexpected<TextError>{file.error()};
  ResponseTable table;
  std::map<int, std::size_t> others;
  const Uff58Function* first = nullptr;
  for (const Uff58Function& f : file->functions) {
    if (f.kind != kFrequencyResponse) {
      ++others[f.kind];
      continue;
    }
    if (first == nullptr) first = &f;
    if (auto done = add(source, f, first->line, table); !done) return Unexpected<TextError>{done.error()};
  }
  std::string passed;
  for (const auto& [kind, count] : others) passed += (passed.empty() ? "" : ", ") + std::to_string(count) + " " + name_of(kind);
  if (file->others > 0) passed += (passed.empty() ? "" : ", ") + std::to_string(file->others) + " other data set";
  if (first == nullptr) return refused_at(0, 0, "no frequency response function (data set 58 of type 4); found " + passed);
  table.format = "universal file, " + counted(table.elements.size(), "frequency response function");
  if (!passed.empty()) table.remarks.push_back("passed over: " + passed);
  if (first->abscissa_unit.empty()) table.remarks.push_back("the file does not say the unit of its frequencies: taken as Hz");
  return table;
}

}  // namespace bodeflow::acquisition
