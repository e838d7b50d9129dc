#pragma once

#include <bodeflow/record_view.hpp>
#include <complex>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace bodeflow::tools::report {

/// An array of a record; complex numbers as two lists. NaN where result.json has null.
struct Array {
  std::string unit;
  std::vector<std::uint64_t> shape;
  std::vector<double> re;
  std::vector<double> im;  ///< empty for real arrays

  bool is_complex() const { return !im.empty(); }
  std::size_t size() const { return re.size(); }
  std::complex<double> at(std::size_t i) const { return {re[i], is_complex() ? im[i] : 0.0}; }
};

/// A record as the report reads it: only arrays whose data fit their shape.
struct Record {
  std::string key;  ///< in result.json
  std::string type;
  nlohmann::ordered_json attributes = nlohmann::ordered_json::object();
  std::vector<std::pair<std::string, Array>> arrays;

  const Array* array(const std::string& name) const;  ///< nullptr: there is none
  /// The array if it is real (complex where asked for) and has that shape, else nullptr.
  const Array* array(const std::string& name, const std::vector<std::uint64_t>& shape, bool complex = false) const;
  std::string text(const std::string& name) const;                ///< "" where absent or no text
  double number(const std::string& name) const;                   ///< NaN where absent or no number
  std::vector<std::string> texts(const std::string& name) const;  ///< empty where absent; one text is a list of one
  std::string text_at(const std::string& name, std::size_t i, const std::string& otherwise) const;
};

/// The product of the sizes; the greatest number where it would be beyond 64 bits.
std::uint64_t count_of(const std::vector<std::uint64_t>& shape);

/// A record of data.h5.
Record record_of(const std::string& key, const RecordView& view);

}  // namespace bodeflow::tools::report
