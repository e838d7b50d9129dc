#include "record_json.hpp"

#include <cmath>

#include "text_file.hpp"

namespace bodeflow::output {
namespace {

void put_text(std::string& out, std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += "\\u00";
      out += kHex[c >> 4];
      out += kHex[c & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

void put(std::string& out, double value) {
  if (std::isfinite(value)) {
    append_number(out, value);
  } else {
    out += "null";
  }
}
void put(std::string& out, std::complex<double> value) {
  out += '[';
  put(out, value.real());
  out += ", ";
  put(out, value.imag());
  out += ']';
}
void put(std::string& out, std::int64_t value) { out += std::to_string(value); }
void put(std::string& out, std::uint8_t value) { out += std::to_string(value); }

/// `[a, b, c]`, each entry written by `each(i)`.
template <class Each>
void put_list(std::string& out, std::size_t size, Each each) {
  out += '[';
  for (std::size_t i = 0; i < size; ++i) {
    if (i != 0) out += ", ";
    each(i);
  }
  out += ']';
}

void put_value(std::string& out, const AttributeView& a, std::size_t i) {
  switch (a.kind()) {
    case AttributeKind::boolean:
      out += a.boolean(i) ? "true" : "false";
      break;
    case AttributeKind::integer:
      put(out, a.integer(i));
      break;
    case AttributeKind::number:
      put(out, a.number(i));
      break;
    case AttributeKind::text:
      put_text(out, a.text(i));
      break;
  }
}

template <class T>
void put_data(std::string& out, const ArrayView& array) {
  const auto data = array.as<T>();
  put_list(out, data.size(), [&](std::size_t i) { put(out, data[i]); });
}

void put_array(std::string& out, const ArrayView& array) {
  out += "{\"unit\": ";
  put_text(out, array.unit);
  out += ", \"shape\": ";
  put_list(out, array.shape.size(), [&](std::size_t i) { out += std::to_string(array.shape[i]); });
  out += ", \"data\": ";
  switch (array.element) {
    case BF_F64:
      put_data<double>(out, array);
      break;
    case BF_C64:
      put_data<std::complex<double>>(out, array);
      break;
    case BF_I64:
      put_data<std::int64_t>(out, array);
      break;
    default:
      put_data<std::uint8_t>(out, array);
      break;
  }
  out += '}';
}

}  // namespace

std::string to_json_line(const RecordView& record, double time_s) {
  std::string out = "{\"time\": ";
  put(out, time_s);
  out += ", \"type\": ";
  put_text(out, record.type());
  out += ", \"attributes\": {";
  const char* between = "";
  for (const AttributeView& a : record.attributes()) {
    out += between;
    between = ", ";
    put_text(out, a.name());
    out += ": ";
    if (a.is_list()) {
      put_list(out, a.size(), [&](std::size_t i) { put_value(out, a, i); });
    } else {
      put_value(out, a, 0);
    }
  }
  out += "}, \"arrays\": {";
  between = "";
  for (const ArrayView& array : record.arrays()) {
    out += between;
    between = ", ";
    put_text(out, array.name);
    out += ": ";
    put_array(out, array);
  }
  return out + "}}";
}

}  // namespace bodeflow::output
