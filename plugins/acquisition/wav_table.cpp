#include "wav_table.hpp"

#include <sndfile.h>

#include <algorithm>
#include <filesystem>

#include "riff.hpp"

namespace bodeflow::acquisition {
namespace {

// Samples of all channels that are read at a time.
constexpr std::size_t kBlock = std::size_t{1} << 16;

struct Close {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

std::string coding_name(int format) {
  SF_FORMAT_INFO info{};
  info.format = format & SF_FORMAT_SUBMASK;
  sf_command(nullptr, SFC_GET_FORMAT_INFO, &info, sizeof info);
  return info.name == nullptr ? "an unknown coding" : info.name;
}

bool keeps_all_digits(int format) {
  switch (format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_S8:
    case SF_FORMAT_PCM_U8:
    case SF_FORMAT_PCM_16:
    case SF_FORMAT_PCM_24:
    case SF_FORMAT_PCM_32:
    case SF_FORMAT_FLOAT:
    case SF_FORMAT_DOUBLE:
      return true;
    default:
      return false;
  }
}

bool is_floating(int format) {
  const int coding = format & SF_FORMAT_SUBMASK;
  return coding == SF_FORMAT_FLOAT || coding == SF_FORMAT_DOUBLE;
}

class SoundReader final : public TableReader {
 public:
  explicit SoundReader(std::string path) : path_(std::move(path)) {}

  Expected<void> open();
  const std::string& file() const override { return path_; }
  const std::vector<Column>& columns() const override { return columns_; }
  Expected<void> start(std::span<const std::size_t> selected, std::int64_t first_row) override;
  Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) override;
  std::string place(std::size_t n) const override {
    return path_ + ": row " + std::to_string(row_ - last_read_ + static_cast<std::int64_t>(n) + 1);
  }
  std::vector<std::string> remarks() const override {
    const std::string coding = coding_name(info_.format);
    return {coding + (is_floating(info_.format) ? ", values as stored" : ", full scale is +-1")};
  }

 private:
  std::string path_;
  SF_INFO info_{};
  std::unique_ptr<SNDFILE, Close> file_;
  std::vector<Column> columns_;
  std::vector<std::size_t> selected_;
  std::vector<double> frames_;
  std::int64_t row_ = 0, last_read_ = 0;
};

Expected<void> SoundReader::open() {
  auto bytes = open_file(path_);
  if (!bytes) return unexpected(path_ + ": " + bytes.error().text);
  std::error_code unknown;
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path_, unknown));
  if (auto done = check_riff(**bytes, size); !done) return unexpected(path_ + ": " + done.error().text);
  file_.reset(sf_open(path_.c_str(), SFM_READ, &info_));
  if (file_ == nullptr) return unexpected(path_ + ": is no sound file that can be read: " + sf_strerror(nullptr));
  if (!keeps_all_digits(info_.format)) {
    return unexpected(path_ + ": is coded as " + coding_name(info_.format) +
                      ", which loses digits; read are integers of 8 to 32 bits and floating-point numbers");
  }
  if (info_.seekable == 0) return unexpected(path_ + ": can't be read a second time");
  for (int c = 1; c <= info_.channels; ++c) {
    Column column;
    column.header = column.name = "ch" + std::to_string(c);
    column.rate = Rate(info_.samplerate, 1);
    column.rows = info_.frames;
    columns_.push_back(std::move(column));
  }
  return {};
}

Expected<void> SoundReader::start(std::span<const std::size_t> selected, std::int64_t first_row) {
  selected_.assign(selected.begin(), selected.end());
  const sf_count_t to = std::min<sf_count_t>(first_row, info_.frames);
  if (sf_seek(file_.get(), to, SEEK_SET) != to) return unexpected(path_ + ": can't be read: " + sf_strerror(file_.get()));
  row_ = to;
  last_read_ = 0;
  return {};
}

Expected<std::size_t> SoundReader::read(std::span<double* const> channels, std::size_t count) {
  const auto width = static_cast<std::size_t>(info_.channels);
  const std::size_t block = std::max<std::size_t>(kBlock / width, 1);
  std::size_t done = 0;
  while (done < count) {
    const std::size_t wanted = std::min(count - done, block);
    frames_.resize(wanted * width);
    const sf_count_t got = sf_readf_double(file_.get(), frames_.data(), static_cast<sf_count_t>(wanted));
    if (sf_error(file_.get()) != SF_ERR_NO_ERROR) return unexpected(path_ + ": can't be read: " + sf_strerror(file_.get()));
    if (got <= 0) break;
    const auto rows = static_cast<std::size_t>(got);
    for (std::size_t c = 0; c < selected_.size(); ++c) {
      for (std::size_t n = 0; n < rows; ++n) channels[c][done + n] = frames_[n * width + selected_[c]];
    }
    done += rows;
  }
  last_read_ = static_cast<std::int64_t>(done);
  row_ += last_read_;
  if (done < count && row_ < info_.frames) {
    return unexpected(path_ + ": cut off: the header states " + std::to_string(info_.frames) + " samples, the file holds " +
                      std::to_string(row_));
  }
  return done;
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_sound(const std::string& path) {
  auto reader = std::make_unique<SoundReader>(path);
  if (auto done = reader->open(); !done) return {Unexpected<Error>{done.error()}};
  return std::unique_ptr<TableReader>(std::move(reader));
}

}  // namespace bodeflow::acquisition
