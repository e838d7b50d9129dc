#include "response_csv.hpp"

#include <algorithm>
#include <array>
#include <bodeflow/units.hpp>
#include <cmath>
#include <numbers>

#include "csv_header.hpp"
#include "csv_row.hpp"
#include "number_line.hpp"
#include "response_axis.hpp"
#include "response_header.hpp"
#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

// Columns rounded to four digits agree better than this; another phase convention does not.
constexpr double kAgreement = 0.01;

struct Part {
  bool present = false;
  std::size_t slot = 0;
  std::string header, unit;
  std::int64_t column = 0;  ///< of the header, in its line
  double to_radian = 1.0;   ///< of a phase
};

/// The columns of one quantity.
struct Quantity {
  std::string name;
  std::array<Part, 7> parts;  ///< by ResponsePart
  PhaseWatch phases{true};
  double disagreement = 0.0;  ///< of magnitude and phase with real and imaginary part, relative
  std::int64_t disagreement_line = 0;

  const Part& part(ResponsePart p) const { return parts[static_cast<std::size_t>(p)]; }
  bool has(ResponsePart p) const { return part(p).present; }
  bool cartesian() const { return has(ResponsePart::real) && has(ResponsePart::imaginary); }
  bool polar() const { return has(ResponsePart::magnitude) && has(ResponsePart::phase); }
  bool decibel() const { return part(ResponsePart::magnitude).unit == "dB"; }
};

class Reader {
 public:
  explicit Reader(ByteSource& source, const std::vector<std::string>& wanted) : lines_(source), wanted_(wanted) {}

  Expected<ResponseTable, TextError> read() {
    if (auto done = read_columns(); !done) return Unexpected<TextError>{done.error()};
    std::vector<int> slots(headers_.size(), -1);
    slots[frequency_.slot] = 0;
    int next = 1;
    for (Quantity& q : quantities_) {
      for (Part& part : q.parts) {
        if (!part.present) continue;
        slots[part.slot] = next;
        part.slot = static_cast<std::size_t>(next++);
      }
    }
    values_.resize(static_cast<std::size_t>(next));
    RowParser parser(separator_, headers_, std::move(slots));
    if (auto done = read_rows(parser); !done) return Unexpected<TextError>{done.error()};
    if (axis_.values().empty()) return refused_at(header_line_, 0, "no rows follow the header");
    return finish(parser);
  }

 private:
  Expected<void, TextError> read_columns() {
    const auto header = read_header(lines_);
    if (!header) return Unexpected<TextError>{header.error()};
    separator_ = header->separator;
    header_line_ = header->line;
    const auto fields = split(lines_.line(), header->line, header->separator);
    if (!fields) return Unexpected<TextError>{fields.error()};
    for (std::size_t c = 0; c < header->columns.size(); ++c) {
      headers_.push_back(header->columns[c].header);
      const auto broken = header->unreadable.find(c);
      if (broken != header->unreadable.end() && response_column(headers_.back())) return Unexpected<TextError>{broken->second};
      if (auto done = take_column(c, (*fields)[c].column); !done) return done;
    }
    if (!frequency_.present)
      return refused_at(header_line_, 1,
                        "no frequency column: `f [Hz]`, `frequency`, `omega [rad/s]`; found " + shown(lines_.line()));
    return check_quantities();
  }

  Expected<void, TextError> take_column(std::size_t index, std::int64_t place) {
    const std::string& header = headers_[index];
    const auto meaning = response_column(header);
    if (!meaning) return other_column(header);
    Part part{true, index, header, meaning->unit, place, 1.0};
    if (meaning->part == ResponsePart::frequency) return take_frequency(std::move(part));
    if (std::find(found_.begin(), found_.end(), meaning->quantity) == found_.end()) found_.push_back(meaning->quantity);
    if (!is_wanted(meaning->quantity, wanted_)) return other_column(header);
    if (meaning->part == ResponsePart::phase) {
      const auto radian = part.unit.empty() ? Expected<double, Error>(unexpected("")) : convert("1 " + part.unit, "rad");
      if (!radian)
        return refused_at(
            header_line_, place,
            "column " + shown(header) + ": a phase needs its unit, `" + std::string(trimmed(header)) + " [deg]` or `[rad]`");
      part.to_radian = *radian;
    }
    auto at =
        std::find_if(quantities_.begin(), quantities_.end(), [&](const Quantity& q) { return q.name == meaning->quantity; });
    if (at == quantities_.end()) {
      quantities_.emplace_back();
      at = quantities_.end() - 1;
      at->name = meaning->quantity;
    }
    Part& place_of_part = at->parts[static_cast<std::size_t>(meaning->part)];
    if (place_of_part.present)
      return refused_at(header_line_, place,
                        "columns " + shown(place_of_part.header) + " and " + shown(header) + " mean the same");
    if (meaning->part == ResponsePart::phase) at->phases = PhaseWatch(part.unit != "rad");
    place_of_part = std::move(part);
    return {};
  }

  Expected<void, TextError> other_column(const std::string& header) {
    others_ += (others_.empty() ? "" : ", ") + header;
    return {};
  }

  Expected<void, TextError> take_frequency(Part part) {
    if (frequency_.present)
      return refused_at(header_line_, part.column,
                        "two frequency columns, " + shown(frequency_.header) + " and " + shown(part.header));
    if (const auto hz = convert("1 " + part.unit, "Hz")) {
      to_hz_ = *hz;
    } else if (const auto radians = convert("1 " + part.unit, "rad/s")) {
      to_hz_ = *radians / (2 * std::numbers::pi);
    } else {
      return refused_at(
          header_line_, part.column,
          "column " + shown(part.header) + ": unit " + shown(part.unit) + " is none of frequency, such as Hz or rad/s");
    }
    frequency_ = std::move(part);
    return {};
  }

  Expected<void, TextError> check_quantities() {
    if (quantities_.empty()) {
      std::string names;
      for (const std::string& name : found_) names += (names.empty() ? "" : ", ") + name;
      if (!names.empty()) return refused_at(header_line_, 0, "no quantity of those wanted; the file has " + names);
      return refused_at(
          header_line_, 0,
          "no response columns: `re(G11)` and `im(G11)`, or `abs(G11)` or `db(G11)` and `phase(G11) [deg]`; found " +
              shown(others_));
    }
    for (Quantity& q : quantities_) {
      if (auto done = check_parts(q); !done) return done;
    }
    return {};
  }

  Expected<void, TextError> check_parts(const Quantity& q) const {
    const auto need = [&](ResponsePart have, ResponsePart lack, const char* word) -> Expected<void, TextError> {
      if (!q.has(have) || q.has(lack)) return {};
      return refused_at(header_line_, q.part(have).column,
                        "column " + shown(q.part(have).header) + " without the " + word + " of " + shown(q.name));
    };
    if (auto done = need(ResponsePart::real, ResponsePart::imaginary, "imaginary part"); !done) return done;
    if (auto done = need(ResponsePart::imaginary, ResponsePart::real, "real part"); !done) return done;
    if (!q.cartesian()) {
      if (auto done = need(ResponsePart::magnitude, ResponsePart::phase, "phase"); !done) return done;
      if (auto done = need(ResponsePart::phase, ResponsePart::magnitude, "magnitude"); !done) return done;
    }
    if (!q.cartesian() && !q.polar()) {
      const Part& lone = q.has(ResponsePart::variance) ? q.part(ResponsePart::variance) : q.part(ResponsePart::deviation);
      return refused_at(header_line_, lone.column, "column " + shown(lone.header) + ": there is no value of " + shown(q.name));
    }
    const Part &re = q.part(ResponsePart::real), &im = q.part(ResponsePart::imaginary);
    if (q.cartesian() && re.unit != im.unit)
      return refused_at(header_line_, im.column,
                        "columns " + shown(re.header) + " and " + shown(im.header) + " differ in their units");
    if (q.has(ResponsePart::variance) && q.has(ResponsePart::deviation))
      return refused_at(header_line_, q.part(ResponsePart::deviation).column,
                        "both variance and standard deviation of " + shown(q.name) + "; one is enough");
    return {};
  }

  Expected<void, TextError> read_rows(RowParser& parser) {
    elements_.resize(quantities_.size());
    std::int64_t empty_line = 0;
    while (true) {
      const auto more = lines_.next();
      if (!more) return Unexpected<TextError>{more.error()};
      if (!*more) return {};
      const std::string_view line = lines_.line();
      if (!line.empty() && line.front() == '#') {
        ++comments_;
      } else if (is_empty(line)) {
        if (empty_line == 0 && !axis_.values().empty()) empty_line = lines_.number();
      } else {
        if (empty_line != 0) return refused_at(empty_line, 1, "empty line between rows: is a point lost here?");
        if (auto done = parser.parse(line, lines_.number(), values_); !done) return done;
        if (auto done = take_row(lines_.number()); !done) return done;
      }
    }
  }

  Expected<void, TextError> take_row(std::int64_t line) {
    const double hz = values_[0] * to_hz_;
    if (!std::isfinite(hz)) return refused_at(line, 0, "the frequency is beyond the range of a double");
    if (auto done = axis_.add(hz, line, 0); !done) return done;
    if (axis_.values().size() * quantities_.size() > kMostResponseValues) return refused_at(line, 0, "more than 33554432 values");
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      Quantity& q = quantities_[i];
      const auto number = [&](ResponsePart p) { return values_[q.part(p).slot]; };
      std::complex<double> polar, value;
      if (q.polar()) {
        const double written = number(ResponsePart::magnitude);
        const double magnitude = q.decibel() ? std::pow(10.0, written / 20.0) : written;
        if (magnitude < 0.0)
          return refused_at(
              line, 0,
              "column " + shown(q.part(ResponsePart::magnitude).header) + ": magnitude " + number_text(written) + "; at least 0");
        if (!std::isfinite(magnitude))
          return refused_at(line, 0,
                            "column " + shown(q.part(ResponsePart::magnitude).header) + ": " + number_text(written) +
                                " dB is beyond the range of a double");
        const double phase = number(ResponsePart::phase) * q.part(ResponsePart::phase).to_radian;
        polar = {magnitude * std::cos(phase), magnitude * std::sin(phase)};
        q.phases.add(number(ResponsePart::phase));
      }
      value = q.cartesian() ? std::complex<double>(number(ResponsePart::real), number(ResponsePart::imaginary)) : polar;
      if (q.cartesian() && q.polar() && !q.decibel()) compare(q, value, polar, line);
      elements_[i].value.push_back(value);
      if (auto done = take_variance(q, elements_[i], line); !done) return done;
    }
    return {};
  }

  static void compare(Quantity& q, std::complex<double> value, std::complex<double> polar, std::int64_t line) {
    const double scale = std::max(std::abs(value), std::abs(polar));
    if (!(scale > 0.0)) return;
    const double d = std::abs(value - polar) / scale;
    if (!(d > q.disagreement)) return;
    q.disagreement = d;
    q.disagreement_line = line;
  }

  Expected<void, TextError> take_variance(const Quantity& q, ResponseElement& element, std::int64_t line) {
    for (const ResponsePart part : {ResponsePart::variance, ResponsePart::deviation}) {
      if (!q.has(part)) continue;
      const double written = values_[q.part(part).slot];
      if (written < 0.0)
        return refused_at(line, 0, "column " + shown(q.part(part).header) + ": " + number_text(written) + "; at least 0");
      const double variance = part == ResponsePart::variance ? written : written * written;
      if (!std::isfinite(variance))
        return refused_at(line, 0, "column " + shown(q.part(part).header) + ": the variance is beyond the range of a double");
      element.variance.push_back(variance);
    }
    return {};
  }

  ResponseTable finish(const RowParser& parser) {
    ResponseTable table;
    table.format = "CSV, frequency in column '" + frequency_.header + "' [" + frequency_.unit + "]";
    table.frequency_hz = axis_.take();
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      const Quantity& q = quantities_[i];
      ResponseElement& element = elements_[i];
      const Part& value = q.part(q.cartesian() ? ResponsePart::real : ResponsePart::magnitude);
      element.quantity = q.name;
      const auto place = matrix_place(q.name);
      element.output = place ? "y" + place->output : q.name;
      element.input = place ? "u" + place->input : "u";
      element.unit = value.unit == "dB" ? "" : value.unit;
      describe(q, table);
      table.elements.push_back(std::move(element));
    }
    if (!others_.empty()) table.remarks.push_back("not read: " + others_);
    if (comments_ > 0) table.remarks.push_back(counted(comments_, "comment line") + " passed over");
    if (parser.decimal_comma()) table.remarks.push_back("decimal commas");
    return table;
  }

  static void describe(const Quantity& q, ResponseTable& table) {
    std::string from = q.name + " from ";
    if (q.cartesian()) {
      from += "real and imaginary part";
    } else {
      from += q.decibel() ? "dB and phase" : "magnitude and phase";
    }
    if (q.has(ResponsePart::variance)) from += ", with variance";
    if (q.has(ResponsePart::deviation)) from += ", with standard deviation";
    const bool both = q.cartesian() && q.polar() && !q.decibel();
    const std::string percent = short_text(100 * q.disagreement) + " %";
    if (both && q.disagreement <= kAgreement) from += ", magnitude and phase agree within " + percent;
    table.remarks.push_back(std::move(from));
    if (both && q.disagreement > kAgreement) {
      table.warnings.push_back(q.name + ": magnitude and phase differ from real and imaginary part by up to " + percent +
                               ", in line " + std::to_string(q.disagreement_line) + "; the latter were read");
    }
    if (!q.cartesian()) {
      if (const auto suspicion = q.phases.suspicion()) table.warnings.push_back(q.name + ": " + *suspicion);
    }
  }

  LineReader lines_;
  const std::vector<std::string>& wanted_;
  std::vector<std::string> headers_, found_;
  std::string others_;
  char separator_ = ',';
  std::int64_t header_line_ = 0;
  Part frequency_;
  double to_hz_ = 1.0;
  std::vector<Quantity> quantities_;
  std::vector<ResponseElement> elements_;
  std::vector<double> values_;
  FrequencyAxis axis_;
  std::size_t comments_ = 0;
};

}  // namespace

Expected<ResponseTable, TextError> read_response_csv(ByteSource& source, const std::vector<std::string>& quantities) {
  return Reader(source, quantities).read();
}

}  // namespace bodeflow::acquisition
