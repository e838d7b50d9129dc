#pragma once

// For the sources that read HDF5, and no others.
#include <hdf5.h>

#include <bodeflow/error.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bodeflow::acquisition::h5 {

/// Owns an HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  /// Ends with Failure, `what` and the library's reason, for a negative identifier.
  Handle(hid_t id, Close close, const std::string& what);
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

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Ends with Failure, `what` and the library's innermost reason, for a negative status.
void check(herr_t status, const std::string& what);

/// Keeps the library from printing its errors in this thread, while it lives.
class Quiet {
 public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// The result of `body`, or what it failed with: "file: why". No errors are printed.
template <class Body>
auto guarded(const std::string& file, Body body) -> Expected<decltype(body())> {
  const Quiet quiet;
  try {
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      return {};
    } else {
      return body();
    }
  } catch (const Failure& f) {
    return unexpected(file + ": " + f.what());
  }
}

/// An HDF5 file for reading; also one that a writer left open. Ends with Failure: no HDF5 file, cut off, damaged.
Handle open_file(const std::string& path);

bool has_attribute(hid_t object, const char* name);
/// The texts of an attribute, nothing where it is absent or holds none.
std::vector<std::string> texts(hid_t object, const char* name);
/// The first text, or "".
std::string text(hid_t object, const char* name);
/// The numbers of an attribute, nothing where it is absent or holds none.
std::vector<double> numbers(hid_t object, const char* name);

/// The shape of a data set; empty for a single value.
std::vector<hsize_t> shape_of(hid_t dataset);

/// Values of a data set as doubles: `count` from `first` on along each dimension.
void read(hid_t dataset, const std::vector<hsize_t>& first, const std::vector<hsize_t>& count, double* to);

}  // namespace bodeflow::acquisition::h5
