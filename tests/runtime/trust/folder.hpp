#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "trust/lab.hpp"

namespace bodeflow::test {

/// A new empty folder that goes away with the object.
class TrustFolder {
 public:
  TrustFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "bodeflow-trust-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("can't make a folder");
    path_ = name;
  }
  ~TrustFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TrustFolder(const TrustFolder&) = delete;
  TrustFolder& operator=(const TrustFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
}

inline void put(const std::filesystem::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

constexpr std::chrono::hours kDay{24};

/// The value, or what was wrong as an exception.
template <class T>
T must(trust::Expected<T> value) {
  if (!value) throw std::runtime_error(value.error());
  if constexpr (!std::is_void_v<T>) return std::move(*value);
}

}  // namespace bodeflow::test
