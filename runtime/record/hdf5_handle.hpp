#pragma once

// The one header that includes HDF5: for the sources of this folder that read or write data.h5, and no others.
#include <hdf5.h>

#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bodeflow::record::h5 {

/// Held during every call of HDF5: the library may be built without thread safety. Also silences its printing of errors.
std::unique_lock<std::mutex> lock();

/// Thrown inside this folder when a call fails: what was tried, and the library's innermost reason.
class Failure : public std::runtime_error {
 public:
  explicit Failure(const std::string& what);
};

/// Owns an HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  /// Throws Failure with `what` for a negative identifier.
  Handle(hid_t id, Close closer, const std::string& what) : id_(id), close_(closer) {
    if (id < 0) throw Failure(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }

  hid_t id() const { return id_; }
  bool open() const { return id_ >= 0; }
  void reset() { Handle().swap(*this); }
  /// Closes now. Throws Failure where that writes and fails.
  void close(const std::string& what) {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    if (id >= 0 && close_(id) < 0) throw Failure(what);
  }

 private:
  void swap(Handle& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
  }

  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Throws Failure with `what` for a negative status.
void check(herr_t status, const std::string& what);

/// The type in the file and in memory of an element type: complex as {r, i}, as h5py and Julia read it.
Handle element_type(std::uint32_t element);
/// A boolean as h5py writes it: an enumeration of FALSE and TRUE.
Handle boolean_type();
/// UTF-8 text of any length.
Handle text_type();
/// A shape; empty: a single value.
Handle space(const std::vector<hsize_t>& shape);

/// Writes an attribute of an object that has none of that name.
void put(hid_t object, const char* name, std::string_view text);
void put(hid_t object, const char* name, std::int64_t value);
void put(hid_t object, const char* name, double value);
void put(hid_t object, const char* name, const std::vector<std::string>& texts);
void put_raw(hid_t object, const char* name, hid_t type, const std::vector<hsize_t>& shape, const void* data);

/// Reads an attribute. Throws Failure if it is not there or of another type.
std::string get_text(hid_t object, const char* name);
std::int64_t get_integer(hid_t object, const char* name);
std::vector<std::string> get_texts(hid_t object, const char* name);

/// A group that may exist already.
Handle group(hid_t parent, const std::string& name);

/// A name as one step of a path in the file.
std::string link_name(std::string_view name);

}  // namespace bodeflow::record::h5
