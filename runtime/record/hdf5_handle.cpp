#include "record/hdf5_handle.hpp"

#include <bodeflow/abi.h>

#include <algorithm>
#include <complex>

namespace bodeflow::record::h5 {
namespace {

herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* text) {
  *static_cast<std::string*>(text) = error->desc != nullptr ? error->desc : "";
  return 1;  // the first is the innermost: stop
}

std::string innermost_reason() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &text);
  return text.empty() ? "no reason given" : text;
}

Handle open_attribute(hid_t object, const char* name) {
  return {H5Aopen(object, name, H5P_DEFAULT), H5Aclose, std::string("can't read the attribute '") + name + "'"};
}

}  // namespace

std::unique_lock<std::mutex> lock() {
  static std::mutex mutex;
  std::unique_lock held(mutex);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return held;
}

Failure::Failure(const std::string& what) : std::runtime_error(what + ": " + innermost_reason()) {}

void check(herr_t status, const std::string& what) {
  if (status < 0) throw Failure(what);
}

Handle element_type(std::uint32_t element) {
  const auto copy = [](hid_t type) { return Handle(H5Tcopy(type), H5Tclose, "can't make a type"); };
  switch (element) {
    case BF_F64:
      return copy(H5T_IEEE_F64LE);
    case BF_I64:
      return copy(H5T_STD_I64LE);
    case BF_U8:
      return copy(H5T_STD_U8LE);
    default:
      break;
  }
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(std::complex<double>)), H5Tclose, "can't make a type");
  check(H5Tinsert(type.id(), "r", 0, H5T_IEEE_F64LE), "can't make a type");
  check(H5Tinsert(type.id(), "i", sizeof(double), H5T_IEEE_F64LE), "can't make a type");
  return type;
}

Handle boolean_type() {
  Handle type(H5Tenum_create(H5T_STD_I8LE), H5Tclose, "can't make a type");
  const std::int8_t no = 0, yes = 1;
  check(H5Tenum_insert(type.id(), "FALSE", &no), "can't make a type");
  check(H5Tenum_insert(type.id(), "TRUE", &yes), "can't make a type");
  return type;
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "can't make a type");
  check(H5Tset_size(type.id(), H5T_VARIABLE), "can't make a type");
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "can't make a type");
  return type;
}

Handle space(const std::vector<hsize_t>& shape) {
  return {shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
          H5Sclose, "can't make a shape"};
}

void put_raw(hid_t object, const char* name, hid_t type, const std::vector<hsize_t>& shape, const void* data) {
  const std::string what = std::string("can't write the attribute '") + name + "'";
  const Handle extent = space(shape);
  const Handle attribute(H5Acreate2(object, name, type, extent.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  check(H5Awrite(attribute.id(), type, data), what);
}

void put(hid_t object, const char* name, std::string_view text) {
  const std::string owned(text);
  const char* pointer = owned.c_str();
  put_raw(object, name, text_type().id(), {}, &pointer);
}

void put(hid_t object, const char* name, std::int64_t value) { put_raw(object, name, H5T_STD_I64LE, {}, &value); }

void put(hid_t object, const char* name, double value) { put_raw(object, name, H5T_IEEE_F64LE, {}, &value); }

void put(hid_t object, const char* name, const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const auto& text : texts) pointers.push_back(text.c_str());
  const char* none = nullptr;
  put_raw(object, name, text_type().id(), {texts.size()}, pointers.empty() ? &none : pointers.data());
}

std::vector<std::string> get_texts(hid_t object, const char* name) {
  const std::string what = std::string("can't read the attribute '") + name + "'";
  const Handle attribute = open_attribute(object, name);
  const Handle extent(H5Aget_space(attribute.id()), H5Sclose, what);
  const hssize_t count = H5Sget_simple_extent_npoints(extent.id());
  std::vector<char*> pointers(count > 0 ? static_cast<std::size_t>(count) : 0);
  std::vector<std::string> texts;
  if (pointers.empty()) return texts;
  const Handle type = text_type();
  check(H5Aread(attribute.id(), type.id(), pointers.data()), what);
  for (const char* pointer : pointers) texts.emplace_back(pointer != nullptr ? pointer : "");
  H5Dvlen_reclaim(type.id(), extent.id(), H5P_DEFAULT, pointers.data());
  return texts;
}

std::string get_text(hid_t object, const char* name) {
  auto texts = get_texts(object, name);
  return texts.empty() ? std::string() : std::move(texts.front());
}

std::int64_t get_integer(hid_t object, const char* name) {
  const Handle attribute = open_attribute(object, name);
  std::int64_t value = 0;
  check(H5Aread(attribute.id(), H5T_NATIVE_INT64, &value), std::string("can't read the attribute '") + name + "'");
  return value;
}

Handle group(hid_t parent, const std::string& name) {
  const std::string what = "can't open the group '" + name + "'";
  if (H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0) return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, what};
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, what};
}

std::string link_name(std::string_view name) {
  std::string link(name);
  std::replace(link.begin(), link.end(), '/', '_');
  return link.empty() || link == "." ? "_" + link : link;
}

}  // namespace bodeflow::record::h5
