#pragma once

#include <bodeflow/describe.hpp>
#include <bodeflow/parameter_types.hpp>
#include <complex>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// The values of a block's parameters, by the names that `describe` gave them. Checked by the host against type, range
/// and choices; numbers are in the parameter's unit. Asking for a name that is not described, for another type, or for
/// an optional parameter that is absent throws Failure.
class Parameters {
 public:
  Parameters(const std::vector<ParameterDraft>& drafts, const std::vector<StoredValue>& values)
      : drafts_(&drafts), values_(&values) {}

  bool boolean(std::string_view name) const { return find(name, BF_BOOL).integer != 0; }
  std::int64_t integer(std::string_view name) const { return find(name, BF_INTEGER).integer; }
  double number(std::string_view name) const { return find(name, BF_NUMBER).numbers[0]; }
  /// Of a text, a choice or a file.
  const std::string& text(std::string_view name) const { return find(name, BF_STRING).strings[0]; }
  const std::vector<double>& numbers(std::string_view name) const { return find(name, BF_NUMBERS).numbers; }
  const std::vector<std::int64_t>& integers(std::string_view name) const { return find(name, BF_INTEGERS).integers; }
  const std::vector<std::string>& texts(std::string_view name) const { return find(name, BF_STRINGS).strings; }
  std::vector<std::complex<double>> complex_list(std::string_view name) const {
    const StoredValue& v = find(name, BF_COMPLEX_LIST);
    std::vector<std::complex<double>> list(v.rows);
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = {v.numbers[2 * i], v.numbers[2 * i + 1]};
    return list;
  }
  Matrix matrix(std::string_view name) const {
    const StoredValue& v = find(name, BF_MATRIX);
    return {v.rows, v.columns, v.numbers};
  }

  /// True if the graph gives the parameter.
  bool given(std::string_view name) const { return (*values_)[index(name)].given; }
  /// True if there is a value: given, or a default.
  bool has(std::string_view name) const {
    const StoredValue& v = (*values_)[index(name)];
    return v.rows != 0 || v.given;
  }

 private:
  std::size_t index(std::string_view name) const {
    for (std::size_t i = 0; i < drafts_->size(); ++i) {
      if ((*drafts_)[i].name == name) return i;
    }
    fail("the block reads a parameter '" + std::string(name) + "' that it does not describe");
  }

  static bool reads(std::uint32_t stored, std::uint32_t asked) {
    return stored == asked || (asked == BF_STRING && (stored == BF_CHOICE || stored == BF_FILE));
  }

  const StoredValue& find(std::string_view name, std::uint32_t type) const {
    const StoredValue& v = (*values_)[index(name)];
    if (!reads(v.type, type)) fail("the block reads parameter '" + std::string(name) + "' as another type than it describes");
    const bool scalar = type == BF_BOOL || type == BF_INTEGER || type == BF_NUMBER || type == BF_STRING;
    if (scalar && v.rows == 0) fail("parameter '" + std::string(name) + "' has no value");
    return v;
  }

  const std::vector<ParameterDraft>* drafts_;
  const std::vector<StoredValue>* values_;
};

}  // namespace v0
}  // namespace bodeflow
