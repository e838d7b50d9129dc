#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

namespace bodeflow::test {

/// Writes small HDF5 files for tests. What can't be written ends the test program.
class Hdf5Writer {
 public:
  /// `userblock`: bytes before the HDF5 part, as in MATLAB's files.
  explicit Hdf5Writer(const std::string& path, hsize_t userblock = 0) {
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    if (userblock != 0) H5Pset_userblock(creation, userblock);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
    H5Pclose(creation);
    links_ = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links_, 1);
  }
  ~Hdf5Writer() {
    H5Pclose(links_);
    H5Fclose(file_);
  }
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  hid_t id() const { return file_; }

  /// Values of `shape`, stored as `type`; chunk: empty for a contiguous data set.
  Hdf5Writer& put(const std::string& path, const std::vector<double>& values, const std::vector<hsize_t>& shape,
                  hid_t type = H5T_IEEE_F64LE, const std::vector<hsize_t>& chunk = {}) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (!chunk.empty()) {
      H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_deflate(creation, 1);
    }
    const hid_t set = create(path, type, shape, creation);
    if (!values.empty()) H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set);
    H5Pclose(creation);
    return *this;
  }
  Hdf5Writer& put(const std::string& path, const std::vector<double>& values) { return put(path, values, {values.size()}); }

  /// A data set of any type without values.
  Hdf5Writer& put_empty(const std::string& path, hid_t type, const std::vector<hsize_t>& shape) {
    H5Dclose(create(path, type, shape, H5P_DEFAULT));
    return *this;
  }

  Hdf5Writer& attribute(const std::string& path, const char* name, const std::string& text) {
    const hid_t type = H5Tcopy(H5T_C_S1), object = H5Oopen(file_, path.c_str(), H5P_DEFAULT), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, text.size());
    write_attribute(object, name, type, space, text.data());
    H5Tclose(type);
    return *this;
  }
  Hdf5Writer& attribute(const std::string& path, const char* name, double value) {
    const hid_t object = H5Oopen(file_, path.c_str(), H5P_DEFAULT), space = H5Screate(H5S_SCALAR);
    write_attribute(object, name, H5T_NATIVE_DOUBLE, space, &value);
    return *this;
  }

 private:
  hid_t create(const std::string& path, hid_t type, const std::vector<hsize_t>& shape, hid_t creation) const {
    const hid_t space =
        shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, path.c_str(), type, space, links_, creation, H5P_DEFAULT);
    H5Sclose(space);
    return set;
  }
  static void write_attribute(hid_t object, const char* name, hid_t type, hid_t space, const void* data) {
    const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, data);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Oclose(object);
  }

  hid_t file_ = H5I_INVALID_HID, links_ = H5I_INVALID_HID;
};

}  // namespace bodeflow::test
