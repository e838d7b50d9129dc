#include "hdf5_object.hpp"

#include <algorithm>

#include "printable.hpp"

namespace bodeflow::acquisition::h5 {
namespace {

herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* text) {
  *static_cast<std::string*>(text) = error->desc != nullptr ? error->desc : "";
  return 1;  // the first is the innermost: stop
}

[[noreturn]] void fail_with_reason(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  fail(printable(reason.empty() ? what : what + ": " + reason));
}

/// An attribute that is there, its space, and how many values it has.
struct Attribute {
  Attribute(hid_t object, const char* name)
      : handle(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, std::string("attribute '") + name + "' can't be read"),
        space(H5Aget_space(handle.id()), H5Sclose, "an attribute can't be read"),
        type(H5Aget_type(handle.id()), H5Tclose, "an attribute can't be read"),
        size(H5Sget_simple_extent_npoints(space.id())) {}

  Handle handle, space, type;
  hssize_t size;
};

// Attributes are short; a longer one is not read.
constexpr hssize_t kMostValues = 1 << 16;

bool readable(const Attribute& a) { return a.size > 0 && a.size <= kMostValues; }

std::vector<std::string> variable_texts(const Attribute& a) {
  std::vector<char*> places(static_cast<std::size_t>(a.size), nullptr);
  const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose, "out of memory");
  check(H5Tset_size(memory.id(), H5T_VARIABLE), "an attribute can't be read");
  check(H5Tset_cset(memory.id(), H5Tget_cset(a.type.id())), "an attribute can't be read");
  check(H5Aread(a.handle.id(), memory.id(), places.data()), "an attribute can't be read");
  std::vector<std::string> all;
  for (const char* p : places) all.emplace_back(p == nullptr ? "" : p);
  H5Dvlen_reclaim(memory.id(), a.space.id(), H5P_DEFAULT, places.data());
  return all;
}

std::vector<std::string> fixed_texts(const Attribute& a) {
  const std::size_t size = H5Tget_size(a.type.id());
  const auto count = static_cast<std::size_t>(a.size);
  if (size == 0 || size > static_cast<std::size_t>(kMostValues)) return {};
  std::vector<char> bytes(size * count);
  check(H5Aread(a.handle.id(), a.type.id(), bytes.data()), "an attribute can't be read");
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) {
    std::string one(bytes.data() + i * size, size);
    one.resize(std::min(one.find('\0'), one.size()));
    one.resize(one.find_last_not_of(' ') + 1);
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace

Handle::Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
  if (id < 0) fail_with_reason(what);
}

void check(herr_t status, const std::string& what) {
  if (status < 0) fail_with_reason(what);
}

Quiet::Quiet() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

/// The library sleeps twice as long from one attempt to the next, 1 ns at first: about a second for what is damaged, where
/// its default of 100 would take for ever.
constexpr unsigned kReadAttempts = 30;

Handle open_file(const std::string& path) {
  hbool_t safe = 0;
  if (H5is_library_threadsafe(&safe) < 0 || safe == 0)
    fail("can't be read: this HDF5 library is built without thread safety, and a run uses it on several threads");
  const htri_t known = H5Fis_hdf5(path.c_str());
  if (known == 0) fail("is not an HDF5 file");
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "can't be opened");
  check(H5Pset_file_locking(access.id(), false, true), "can't be opened");  // a reader never stops a writer
  check(H5Pset_metadata_read_attempts(access.id(), kReadAttempts), "can't be opened");
  hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
  if (file < 0) {  // the recording of a run that was killed says that it is still being written
    const hid_t again = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.id());
    if (again >= 0) return {again, H5Fclose, ""};
    file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());  // the first reason tells more
  }
  return {file, H5Fclose, "can't be opened"};
}

bool has_attribute(hid_t object, const char* name) { return H5Aexists(object, name) > 0; }

std::vector<std::string> texts(hid_t object, const char* name) {
  if (!has_attribute(object, name)) return {};
  const Attribute a(object, name);
  if (!readable(a) || H5Tget_class(a.type.id()) != H5T_STRING) return {};
  return H5Tis_variable_str(a.type.id()) > 0 ? variable_texts(a) : fixed_texts(a);
}

std::string text(hid_t object, const char* name) {
  auto all = texts(object, name);
  return all.empty() ? "" : std::move(all.front());
}

std::vector<double> numbers(hid_t object, const char* name) {
  if (!has_attribute(object, name)) return {};
  const Attribute a(object, name);
  const H5T_class_t kind = H5Tget_class(a.type.id());
  if (!readable(a) || (kind != H5T_FLOAT && kind != H5T_INTEGER)) return {};
  std::vector<double> all(static_cast<std::size_t>(a.size));
  check(H5Aread(a.handle.id(), H5T_NATIVE_DOUBLE, all.data()), "an attribute can't be read");
  return all;
}

std::vector<hsize_t> shape_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose, "a data set can't be read");
  const int rank = H5Sget_simple_extent_ndims(space.id());
  check(rank, "a data set can't be read");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  if (rank > 0) check(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), "a data set can't be read");
  return shape;
}

void read(hid_t dataset, const std::vector<hsize_t>& first, const std::vector<hsize_t>& count, double* to) {
  const Handle file_space(H5Dget_space(dataset), H5Sclose, "values can't be read");
  check(H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr),
        "values can't be read");
  const Handle memory_space(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose,
                            "values can't be read");
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory_space.id(), file_space.id(), H5P_DEFAULT, to), "values can't be read");
}

}  // namespace bodeflow::acquisition::h5
