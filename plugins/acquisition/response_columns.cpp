#include "response_columns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "csv_row.hpp"
#include "number_line.hpp"
#include "response_axis.hpp"
#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::string_view kComment = "*#;!\"/%";
constexpr std::string_view kBlanks = " \t;";
constexpr std::string_view kBlanksAndComma = " \t;,";

bool begins_with_number(std::string_view text) {
  const std::size_t at = text.find_first_not_of("+-.");
  return at != std::string_view::npos && at < 3 && text[at] >= '0' && text[at] <= '9';
}

/// Three words with commas between digits and no points: decimal commas.
bool has_decimal_commas(std::string_view line) {
  if (line.find('.') != std::string_view::npos || line.find(',') == std::string_view::npos) return false;
  std::size_t words = 0;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos; ++words) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    const std::string_view word = line.substr(at, end - at);
    if (word.front() == ',' || word.back() == ',' || std::count(word.begin(), word.end(), ',') > 1) return false;
    at = line.find_first_not_of(kBlanks, end);
  }
  return words == 3;
}

class Reader {
 public:
  Reader(ByteSource& source, LoudspeakerFile kind) : lines_(source), kind_(kind), phases_(true) {}

  Expected<ResponseTable, TextError> read() {
    while (true) {
      const auto more = lines_.next();
      if (!more) return Unexpected<TextError>{more.error()};
      if (!*more) break;
      const std::string_view line = trimmed(lines_.line());
      if (line.empty()) continue;
      if (kComment.find(line.front()) != std::string_view::npos) {
        ++comments_;
      } else if (axis_.values().empty() && !begins_with_number(line)) {
        ++titles_;
      } else if (auto done = take(lines_.line(), lines_.number()); !done) {
        return Unexpected<TextError>{done.error()};
      }
    }
    if (axis_.values().empty())
      return refused_at(0, 0, lines_.number() == 0 ? "empty file" : "no points: no line begins with a number");
    return finish();
  }

 private:
  Expected<void, TextError> take(std::string_view line, std::int64_t number) {
    if (axis_.values().empty()) decimal_commas_ = has_decimal_commas(line);
    std::string owned;
    if (decimal_commas_) {
      owned = line;
      std::replace(owned.begin(), owned.end(), ',', '.');
      line = owned;
    }
    if (auto done = read_numbers(line, number, decimal_commas_ ? kBlanks : kBlanksAndComma, fields_); !done) return done;
    if (fields_.size() == 2)
      return refused_at(number, 0, "2 numbers: a response needs frequency, magnitude and phase [deg]; here the phase is missing");
    if (fields_.size() != 3)
      return refused_at(number, fields_.size() > 3 ? fields_[3].column : 0,
                        counted(fields_.size(), "number") + "; 3 a line: frequency [Hz], magnitude, phase [deg]");
    const double magnitude = kind_ == LoudspeakerFile::frd ? std::pow(10.0, fields_[1].value / 20.0) : fields_[1].value;
    if (!std::isfinite(magnitude))
      return refused_at(number, fields_[1].column, number_text(fields_[1].value) + " dB is beyond the range of a double");
    if (magnitude < 0.0) return refused_at(number, fields_[1].column, "impedance " + number_text(magnitude) + " ohm; at least 0");
    if (auto done = axis_.add(fields_[0].value, number, fields_[0].column); !done) return done;
    phases_.add(fields_[2].value);
    const double phase = fields_[2].value * std::numbers::pi / 180.0;
    values_.emplace_back(magnitude * std::cos(phase), magnitude * std::sin(phase));
    return {};
  }

  ResponseTable finish() {
    const bool impedance = kind_ == LoudspeakerFile::zma;
    ResponseTable table;
    table.format = impedance ? "zma: magnitude in ohm, phase in deg" : "frd: magnitude in dB, phase in deg";
    table.frequency_hz = axis_.take();
    ResponseElement element;
    element.quantity = impedance ? "Z" : "G";
    element.output = impedance ? "voltage" : "y";
    element.input = impedance ? "current" : "u";
    element.unit = impedance ? "ohm" : "";
    element.value = std::move(values_);
    table.elements.push_back(std::move(element));
    if (!impedance) table.remarks.push_back("the file does not say what 0 dB is");
    if (comments_ > 0) table.remarks.push_back(counted(comments_, "comment line") + " passed over");
    if (titles_ > 0) table.remarks.push_back(counted(titles_, "line") + " of text before the first point passed over");
    if (decimal_commas_) table.remarks.push_back("decimal commas");
    if (const auto suspicion = phases_.suspicion()) table.warnings.push_back("phase: " + *suspicion);
    return table;
  }

  LineReader lines_;
  LoudspeakerFile kind_;
  FrequencyAxis axis_;
  PhaseWatch phases_;
  std::vector<NumberField> fields_;
  std::vector<std::complex<double>> values_;
  std::size_t comments_ = 0, titles_ = 0;
  bool decimal_commas_ = false;
};

}  // namespace

Expected<ResponseTable, TextError> read_loudspeaker_file(ByteSource& source, LoudspeakerFile kind) {
  return Reader(source, kind).read();
}

}  // namespace bodeflow::acquisition
