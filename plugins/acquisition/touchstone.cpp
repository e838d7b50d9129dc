#include "touchstone.hpp"

#include <cmath>
#include <numbers>

#include "csv_row.hpp"
#include "number_line.hpp"
#include "response_axis.hpp"
#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

enum class Form { decibel, magnitude, real_imaginary };

struct Options {
  double hz_per_unit = 1e9;
  char parameter = 'S';
  Form form = Form::magnitude;
  double reference_ohm = 50.0;
};

struct Word {
  std::string text;  ///< in lower case
  std::int64_t column = 1;
};

std::vector<Word> words_of(std::string_view line, std::size_t begin) {
  std::vector<Word> words;
  for (std::size_t at = line.find_first_not_of(" \t", begin); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back({lower_case(line.substr(at, end - at)), static_cast<std::int64_t>(at) + 1});
    at = line.find_first_not_of(" \t", end);
  }
  return words;
}

std::optional<double> frequency_unit(const std::string& word) {
  if (word == "hz") return 1.0;
  if (word == "khz") return 1e3;
  if (word == "mhz") return 1e6;
  if (word == "ghz") return 1e9;
  return std::nullopt;
}

std::optional<Form> form_of(const std::string& word) {
  if (word == "db") return Form::decibel;
  if (word == "ma") return Form::magnitude;
  if (word == "ri") return Form::real_imaginary;
  return std::nullopt;
}

Expected<Options, TextError> read_options(std::string_view line, std::int64_t number) {
  Options options;
  const std::vector<Word> words = words_of(line, line.find('#') + 1);
  bool unit = false, parameter = false, form = false, reference = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Word& word = words[i];
    const auto twice = [&](bool& seen) { return std::exchange(seen, true); };
    bool repeated = false;
    if (const auto hz = frequency_unit(word.text)) {
      options.hz_per_unit = *hz;
      repeated = twice(unit);
    } else if (const auto found = form_of(word.text)) {
      options.form = *found;
      repeated = twice(form);
    } else if (word.text == "s" || word.text == "y" || word.text == "z") {
      options.parameter = static_cast<char>(word.text[0] - 32);
      repeated = twice(parameter);
    } else if (word.text == "g" || word.text == "h") {
      return refused_at(number, word.column, "hybrid parameters " + shown(word.text) + " are not read; allowed: S, Y, Z");
    } else if (word.text == "r") {
      repeated = twice(reference);
      if (i + 1 == words.size()) return refused_at(number, word.column, "R without the reference resistance in ohm");
      const Word& value = words[++i];
      const auto ohm = number_of(value.text);
      if (!ohm) return refused_at(number, value.column, "reference resistance " + ohm.error().text);
      if (!(*ohm > 0.0)) return refused_at(number, value.column, "reference resistance " + number_text(*ohm) + " ohm; above 0");
      options.reference_ohm = *ohm;
    } else {
      return refused_at(number, word.column,
                        "option " + shown(word.text) + "; allowed: Hz, kHz, MHz, GHz; S, Y, Z; DB, MA, RI; R and a number");
    }
    if (repeated) return refused_at(number, word.column, "option " + shown(word.text) + ": the second of its kind");
  }
  return options;
}

class TouchstoneReader {
 public:
  TouchstoneReader(ByteSource& source, int ports)
      : lines_(source), ports_(static_cast<std::size_t>(ports)), needed_(1 + 2 * ports_ * ports_) {
    table_.elements.resize(ports_ * ports_);
  }

  Expected<ResponseTable, TextError> read() {
    while (true) {
      const auto more = lines_.next();
      if (!more) return Unexpected<TextError>{more.error()};
      if (!*more) break;
      std::string_view line = lines_.line();
      const std::size_t comment = line.find('!');
      if (comment != std::string_view::npos) {
        ++comments_;
        line = line.substr(0, comment);
      }
      if (auto done = take_line(line); !done) return Unexpected<TextError>{done.error()};
    }
    if (!point_.empty()) return incomplete("when the file ends");
    if (axis_.values().empty()) return refused_at(0, 0, options_ ? "no points" : "empty file: no option line, no points");
    return finish();
  }

 private:
  Expected<void, TextError> take_line(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    const std::int64_t number = lines_.number(), column = static_cast<std::int64_t>(first) + 1;
    if (line[first] == '#') {
      if (options_) {
        further_options_ = true;
        return {};
      }
      const auto options = read_options(line, number);
      if (!options) return Unexpected<TextError>{options.error()};
      options_ = *options;
      return {};
    }
    if (line[first] == '[') {
      return refused_at(number, column,
                        "keyword " + shown(line.substr(first)) + ": Touchstone 2 is not read; save the file as version 1");
    }
    if (!options_)
      return refused_at(number, column,
                        "no option line before the first point, such as '# GHz S MA R 50'; found " + shown(line.substr(first)));
    if (auto done = read_numbers(line, number, " \t", fields_); !done) return done;
    return take_numbers(number);
  }

  Expected<void, TextError> take_numbers(std::int64_t number) {
    if (in_noise_ || begins_noise()) return take_noise(number);
    const bool odd = fields_.size() % 2 == 1;
    if (point_.empty()) {
      if (!odd) {
        return refused_at(number, fields_.front().column,
                          counted(fields_.size(), "number") + " where a point begins: its frequency and pairs are " +
                              std::to_string(needed_) + " for " + counted(ports_, "port"));
      }
      point_line_ = number;
      point_column_ = fields_.front().column;
    } else if (odd) {
      return incomplete("when the next begins in line " + std::to_string(number));
    }
    for (const NumberField& f : fields_) {
      if (point_.size() == needed_) {
        return refused_at(
            number, f.column,
            "surplus number: a point of " + counted(ports_, "port") + " has " + std::to_string(needed_) + " with its frequency");
      }
      point_.push_back(f.value);
    }
    return point_.size() == needed_ ? end_point() : Expected<void, TextError>();
  }

  /// Noise parameters follow those of a two-port with frequencies that begin again, five numbers a line.
  bool begins_noise() const {
    return ports_ == 2 && point_.empty() && fields_.size() == 5 && !axis_.values().empty() &&
           fields_.front().value * options_->hz_per_unit <= axis_.values().back();
  }

  Expected<void, TextError> take_noise(std::int64_t number) {
    if (fields_.size() != 5) {
      return refused_at(number, fields_.front().column,
                        counted(fields_.size(), "number") +
                            " in the noise parameters; 5 a line: frequency, minimum noise figure, "
                            "reflection (magnitude, angle), resistance");
    }
    in_noise_ = true;
    ++noise_points_;
    return {};
  }

  Unexpected<TextError> incomplete(const std::string& when) const {
    return refused_at(point_line_, 0,
                      "the point has " + std::to_string(point_.size()) + " numbers " + when + "; " + std::to_string(needed_) +
                          " for " + counted(ports_, "port"));
  }

  Expected<void, TextError> end_point() {
    const double hz = point_.front() * options_->hz_per_unit;
    if (!std::isfinite(hz)) return refused_at(point_line_, point_column_, "the frequency is beyond the range of a double");
    if (auto done = axis_.add(hz, point_line_, point_column_); !done) return done;
    if (axis_.values().size() * ports_ * ports_ > kMostResponseValues)
      return refused_at(point_line_, 0, "more than 33554432 values");
    for (std::size_t e = 0; e < ports_ * ports_; ++e) {
      const std::complex<double> value = value_of(point_[1 + 2 * e], point_[2 + 2 * e]);
      if (!std::isfinite(value.real()) || !std::isfinite(value.imag()))
        return refused_at(point_line_, 0, "a value is beyond the range of a double");
      table_.elements[e].value.push_back(value);
    }
    point_.clear();
    return {};
  }

  std::complex<double> value_of(double a, double b) const {
    const double scale = options_->parameter == 'Z'   ? options_->reference_ohm
                         : options_->parameter == 'Y' ? 1.0 / options_->reference_ohm
                                                      : 1.0;
    if (options_->form == Form::real_imaginary) return {scale * a, scale * b};
    const double magnitude = options_->form == Form::decibel ? std::pow(10.0, a / 20.0) : a;
    const double phase = b * std::numbers::pi / 180.0;
    return {scale * magnitude * std::cos(phase), scale * magnitude * std::sin(phase)};
  }

  ResponseTable finish() {
    const char parameter = options_->parameter;
    table_.frequency_hz = axis_.take();
    for (std::size_t e = 0; e < ports_ * ports_; ++e) {
      std::size_t row = e / ports_, column = e % ports_;
      if (ports_ == 2) std::swap(row, column);  // S11 S21 S12 S22
      const std::string i = std::to_string(row + 1), j = std::to_string(column + 1);
      ResponseElement& element = table_.elements[e];
      element.quantity = parameter + i + (ports_ > 9 ? "," : "") + j;
      element.output = (parameter == 'S' ? "b" : parameter == 'Z' ? "v" : "i") + i;
      element.input = (parameter == 'S' ? "a" : parameter == 'Z' ? "i" : "v") + j;
      element.unit = parameter == 'S' ? "1" : parameter == 'Z' ? "ohm" : "S";
    }
    const std::string reference = number_text(options_->reference_ohm) + " ohm";
    table_.format = "Touchstone 1, " + counted(ports_, "port") + ", " + parameter + " parameters, reference " + reference;
    if (parameter != 'S')
      table_.remarks.push_back("normalised to " + reference + " in the file, given back in " + table_.elements.front().unit);
    if (comments_ > 0) table_.remarks.push_back(counted(comments_, "comment") + " passed over");
    if (further_options_) table_.remarks.push_back("option lines after the first passed over");
    if (noise_points_ > 0)
      table_.remarks.push_back("noise parameters at " + counted(noise_points_, "frequency point") + " passed over");
    return std::move(table_);
  }

  LineReader lines_;
  std::size_t ports_, needed_;
  std::optional<Options> options_;
  FrequencyAxis axis_;
  ResponseTable table_;
  std::vector<NumberField> fields_;
  std::vector<double> point_;
  std::int64_t point_line_ = 0, point_column_ = 0;
  std::size_t comments_ = 0, noise_points_ = 0;
  bool in_noise_ = false, further_options_ = false;
};

}  // namespace

Expected<ResponseTable, TextError> read_touchstone(ByteSource& source, int ports) {
  return TouchstoneReader(source, ports).read();
}

std::optional<int> touchstone_ports(const std::string& ending) {
  if (ending.size() < 4 || ending.size() > 5 || ending.compare(0, 2, ".s") != 0 || ending.back() != 'p') return std::nullopt;
  int ports = 0;
  for (std::size_t i = 2; i + 1 < ending.size(); ++i) {
    if (ending[i] < '0' || ending[i] > '9') return std::nullopt;
    ports = 10 * ports + (ending[i] - '0');
  }
  if (ports < 1) return std::nullopt;
  return ports;
}

}  // namespace bodeflow::acquisition
