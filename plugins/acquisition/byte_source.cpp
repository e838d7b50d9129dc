#include "byte_source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace bodeflow::acquisition {
namespace {

std::string reason(int number) { return std::generic_category().message(number); }

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

class FileSource final : public ByteSource {
 public:
  explicit FileSource(std::FILE* file) : file_(file) {}

  Expected<std::size_t> read(char* to, std::size_t size) override {
    const std::size_t got = std::fread(to, 1, size, file_.get());
    if (got == 0 && std::ferror(file_.get()) != 0) return unexpected("can't be read: " + reason(errno));
    return got;
  }

  Expected<void> seek(std::int64_t offset) override {
    if (::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0)
      return unexpected("can't be read a second time: " + reason(errno));
    return {};
  }

 private:
  std::unique_ptr<std::FILE, Close> file_;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string_view text) : text_(text) {}

  Expected<std::size_t> read(char* to, std::size_t size) override {
    const std::size_t got = std::min(size, text_.size() - at_);
    if (got != 0) std::memcpy(to, text_.data() + at_, got);
    at_ += got;
    return got;
  }

  Expected<void> seek(std::int64_t offset) override {
    at_ = std::min(static_cast<std::size_t>(offset), text_.size());
    return {};
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Expected<std::unique_ptr<ByteSource>> open_file(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) return unexpected("is a folder, not a file");
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown))
    return unexpected("is not a regular file");
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return unexpected("can't be opened: " + reason(errno));
  std::setvbuf(file, nullptr, _IONBF, 0);  // the line reader has its own buffer
  return std::unique_ptr<ByteSource>(new FileSource(file));
}

std::unique_ptr<ByteSource> open_memory(std::string_view text) { return std::make_unique<MemorySource>(text); }

}  // namespace bodeflow::acquisition
