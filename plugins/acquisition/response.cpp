#include "response.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "byte_source.hpp"
#include "number_line.hpp"
#include "response_columns.hpp"
#include "response_csv.hpp"
#include "response_header.hpp"
#include "sampling.hpp"
#include "touchstone.hpp"
#include "uff_response.hpp"

namespace bodeflow::acquisition {
namespace {

// Steps of rounded frequencies count as equal within this part of a step.
constexpr double kGridTolerance = 0.1;

bool is_one_of(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return text == word; });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

/// The elements that are wanted.
Expected<std::vector<ResponseElement>> chosen(std::vector<ResponseElement> elements, const std::vector<std::string>& quantities) {
  std::vector<std::string> names;
  for (const ResponseElement& e : elements) names.push_back(e.quantity);
  for (const std::string& quantity : quantities) {
    if (std::none_of(names.begin(), names.end(), [&](const std::string& name) { return is_wanted(name, {quantity}); }))
      return unexpected("no quantity '" + quantity + "'; the file has " + joined(names));
  }
  std::erase_if(elements, [&](const ResponseElement& e) { return !is_wanted(e.quantity, quantities); });
  return elements;
}

/// The element at each place of the matrix.
Expected<std::vector<const ResponseElement*>> placed(const std::vector<ResponseElement>& elements, Response& response) {
  std::map<std::pair<std::size_t, std::size_t>, const ResponseElement*> places;
  for (const ResponseElement& e : elements) {
    const auto place = std::pair(place_of(response.output_names, e.output), place_of(response.input_names, e.input));
    const auto [before, fresh] = places.emplace(place, &e);
    if (!fresh) {
      return unexpected("'" + before->second->quantity + "' and '" + e.quantity + "' are both the response from '" + e.input +
                        "' to '" + e.output + "'; name one with `quantity`");
    }
  }
  std::vector<const ResponseElement*> matrix;
  for (std::size_t i = 0; i < response.output_names.size(); ++i) {
    for (std::size_t j = 0; j < response.input_names.size(); ++j) {
      const auto found = places.find({i, j});
      if (found == places.end()) {
        return unexpected("no response from '" + response.input_names[j] + "' to '" + response.output_names[i] +
                          "': " + std::to_string(places.size()) + " of " + std::to_string(response.output_names.size()) + " x " +
                          std::to_string(response.input_names.size()) +
                          " elements are there; name some that fill a matrix with `quantity`");
      }
      matrix.push_back(found->second);
    }
  }
  return matrix;
}

/// The format of a file's text, by its ending.
Expected<ResponseTable, TextError> read_text(ByteSource& source, const std::string& ending,
                                             const std::vector<std::string>& quantities) {
  if (ending == ".frd") return read_loudspeaker_file(source, LoudspeakerFile::frd);
  if (ending == ".zma") return read_loudspeaker_file(source, LoudspeakerFile::zma);
  if (const auto ports = touchstone_ports(ending)) return read_touchstone(source, *ports);
  if (is_one_of(ending, {".uff", ".unv", ".u58"})) return read_uff_response(source);
  return read_response_csv(source, quantities);
}

}  // namespace

bool is_wanted(const std::string& quantity, const std::vector<std::string>& quantities) {
  if (quantities.empty()) return true;
  const auto place = matrix_place(quantity);
  return std::any_of(quantities.begin(), quantities.end(),
                     [&](const std::string& wanted) { return wanted == quantity || (place && wanted == place->letters); });
}

Expected<ResponseTable> read_response(const std::string& path, const std::vector<std::string>& quantities) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (!is_one_of(ending, {".csv", ".txt", ".tsv", ".dat", ".frd", ".zma", ".uff", ".unv", ".u58"}) && !touchstone_ports(ending)) {
    return unexpected(path + ": ending '" + ending +
                      "'; read are .csv, .txt, .tsv, .dat, .s1p to .s99p (Touchstone), .frd, .zma, .uff, .unv, .u58");
  }
  const auto source = open_file(path);
  if (!source) return unexpected(path + ": " + source.error().text);
  auto table = read_text(**source, ending, quantities);
  if (!table) return unexpected(text_at(path, table.error()));
  return std::move(*table);
}

Expected<Response> assemble(ResponseTable table, const ResponseSelection& wanted) {
  const auto elements = chosen(std::move(table.elements), wanted.quantities);
  if (!elements) return Unexpected<Error>{elements.error()};
  Response response;
  const auto matrix = placed(*elements, response);
  if (!matrix) return Unexpected<Error>{matrix.error()};
  const auto with_variance = static_cast<std::size_t>(
      std::count_if(matrix->begin(), matrix->end(), [](const ResponseElement* e) { return !e->variance.empty(); }));
  if (with_variance != 0 && with_variance != matrix->size())
    return unexpected("variances of " + std::to_string(with_variance) + " of " + std::to_string(matrix->size()) +
                      " elements alone");
  const double infinity = std::numeric_limits<double>::infinity();
  const auto [low, high] = wanted.band_hz.value_or(std::pair(0.0, infinity));
  const std::vector<double>& f = table.frequency_hz;
  const auto first = static_cast<std::size_t>(std::lower_bound(f.begin(), f.end(), low) - f.begin());
  const auto last = static_cast<std::size_t>(std::upper_bound(f.begin(), f.end(), high) - f.begin());
  if (first >= last) {
    return unexpected("no point within the band from " + short_text(low) + " to " + short_text(high) + " Hz; the file has " +
                      short_text(f.front()) + " to " + short_text(f.back()) + " Hz");
  }
  response.frequency_hz.assign(f.begin() + static_cast<std::ptrdiff_t>(first), f.begin() + static_cast<std::ptrdiff_t>(last));
  for (std::size_t k = first; k < last; ++k) {
    for (const ResponseElement* e : *matrix) {
      response.value.push_back(e->value[k]);
      if (with_variance != 0) response.variance.push_back(e->variance[k]);
    }
  }
  for (const ResponseElement* e : *matrix) response.units.push_back(e->unit);
  response.format = std::move(table.format);
  response.remarks = std::move(table.remarks);
  response.warnings = std::move(table.warnings);
  if (const std::size_t outside = f.size() - (last - first); outside > 0)
    response.remarks.push_back(counted(outside, "point") + " outside the band left out");
  if (!(response.frequency_hz.front() > 0.0))
    response.warnings.push_back("the first point is at 0 Hz: a fit over a logarithmic axis can't use it; `band` leaves it out");
  return response;
}

std::string grid_text(const std::vector<double>& f) {
  if (f.size() < 3) return "";
  const auto even_step = [&](auto&& of, std::size_t first) {
    const double step = (of(f.back()) - of(f[first])) / static_cast<double>(f.size() - 1 - first);
    for (std::size_t k = first + 1; k < f.size(); ++k) {
      if (!(std::abs(of(f[k]) - of(f[k - 1]) - step) <= kGridTolerance * step)) return 0.0;
    }
    return step;
  };
  const std::size_t positive = f.front() > 0.0 ? 0 : 1;
  const double linear = even_step([](double x) { return x; }, 0);
  if (linear > 0.0) return "linear grid, " + short_text(linear) + " Hz apart";
  const double octaves = f.size() < positive + 3 ? 0.0 : even_step([](double x) { return std::log2(x); }, positive);
  if (octaves > 0.0) return "logarithmic grid, " + short_text(1.0 / octaves) + " points an octave";
  return "irregular grid";
}

std::string summary_of(const Response& r) {
  std::string text = r.format + "; " + counted(r.frequency_hz.size(), "point") + ", " + short_text(r.frequency_hz.front()) +
                     " to " + short_text(r.frequency_hz.back()) + " Hz";
  const std::string grid = grid_text(r.frequency_hz);
  if (!grid.empty()) text += ", " + grid;
  text += "; outputs " + joined(r.output_names) + "; inputs " + joined(r.input_names);
  const bool common = std::count(r.units.begin(), r.units.end(), r.units.front()) == static_cast<std::ptrdiff_t>(r.units.size());
  if (common) {
    text += r.units.front().empty() ? "; unit not stated" : "; unit " + r.units.front();
  } else {
    std::vector<std::string> units;
    for (const std::string& unit : r.units) units.push_back(unit.empty() ? "not stated" : unit);
    text += "; units " + joined(units);
  }
  text += r.variance.empty() ? "; no variance" : "; with variance";
  for (const std::string& remark : r.remarks) text += "; " + remark;
  return text;
}

}  // namespace bodeflow::acquisition
