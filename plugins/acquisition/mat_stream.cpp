#include "mat_stream.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace bodeflow::acquisition {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;

Unexpected<Error> forward(const Error& e) { return {e}; }

class PlainStream final : public MatStream {
 public:
  PlainStream(ByteSource& source, const MatExtent& extent) : source_(source), extent_(extent) {}

  std::int64_t position() const override { return position_; }

  Expected<void> read(char* to, std::size_t size) override {
    if (size > static_cast<std::size_t>(extent_.size - position_)) return unexpected("its bytes end too early");
    for (std::size_t done = 0; done < size;) {
      const auto got = source_.read(to + done, size - done);
      if (!got) return forward(got.error());
      if (*got == 0) return unexpected("its bytes end too early");
      done += *got;
    }
    position_ += static_cast<std::int64_t>(size);
    return {};
  }

  Expected<void> skip_to(std::int64_t position) override {
    if (position > extent_.size) return unexpected("its bytes end too early");
    position_ = position;
    return source_.seek(extent_.offset + position);
  }

  Expected<void> verify() override { return {}; }

 private:
  ByteSource& source_;
  MatExtent extent_;
  std::int64_t position_ = 0;
};

class InflatedStream final : public MatStream {
 public:
  InflatedStream(ByteSource& source, const MatExtent& extent) : source_(source), left_(extent.size), in_(kBlock) {
    ready_ = inflateInit(&state_) == Z_OK;
  }
  ~InflatedStream() override {
    if (ready_) inflateEnd(&state_);
  }

  std::int64_t position() const override { return position_; }

  Expected<void> read(char* to, std::size_t size) override {
    const auto got = inflate_up_to(to, size);
    if (!got) return forward(got.error());
    if (*got < size) return unexpected("its compressed bytes end too early");
    return {};
  }

  Expected<void> skip_to(std::int64_t position) override {
    std::array<char, 4096> passed;
    while (position_ < position) {
      const auto size = static_cast<std::size_t>(std::min<std::int64_t>(position - position_, passed.size()));
      if (auto done = read(passed.data(), size); !done) return done;
    }
    return {};
  }

  Expected<void> verify() override {
    std::array<char, 4096> passed;
    while (!ended_) {
      const auto got = inflate_up_to(passed.data(), passed.size());
      if (!got) return forward(got.error());
      if (*got < passed.size() && !ended_) return unexpected("its compressed bytes end too early");
    }
    return {};
  }

 private:
  Expected<std::size_t> inflate_up_to(char* to, std::size_t size);
  Expected<bool> refill();

  ByteSource& source_;
  std::int64_t left_;  // compressed bytes not yet read
  std::vector<char> in_;
  z_stream state_{};
  bool ready_ = false, ended_ = false;
  std::int64_t position_ = 0;
};

/// More compressed bytes; false where there are none.
Expected<bool> InflatedStream::refill() {
  const auto wanted = static_cast<std::size_t>(std::min<std::int64_t>(left_, static_cast<std::int64_t>(in_.size())));
  const auto got = source_.read(in_.data(), wanted);
  if (!got) return forward(got.error());
  left_ -= static_cast<std::int64_t>(*got);
  state_.next_in = reinterpret_cast<Bytef*>(in_.data());
  state_.avail_in = static_cast<uInt>(*got);
  return *got != 0;
}

/// `size` bytes, or fewer at the end of the compressed bytes.
Expected<std::size_t> InflatedStream::inflate_up_to(char* to, std::size_t size) {
  if (!ready_) return unexpected("out of memory");
  std::size_t done = 0;
  while (done < size && !ended_) {
    if (state_.avail_in == 0) {
      const auto more = refill();
      if (!more) return forward(more.error());
      if (!*more) break;
    }
    const auto part = static_cast<uInt>(std::min(size - done, std::size_t{1} << 30));
    state_.next_out = reinterpret_cast<Bytef*>(to + done);
    state_.avail_out = part;
    const int status = inflate(&state_, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END)
      return unexpected(std::string("its compressed bytes are damaged") + (state_.msg == nullptr ? "" : ": ") +
                        (state_.msg == nullptr ? "" : state_.msg));
    done += part - state_.avail_out;
    ended_ = status == Z_STREAM_END;
  }
  position_ += static_cast<std::int64_t>(done);
  return done;
}

}  // namespace

Expected<std::unique_ptr<MatStream>> open_mat_stream(ByteSource& source, const MatExtent& extent) {
  if (auto done = source.seek(extent.offset); !done) return forward(done.error());
  if (extent.compressed) return std::unique_ptr<MatStream>(new InflatedStream(source, extent));
  return std::unique_ptr<MatStream>(new PlainStream(source, extent));
}

}  // namespace bodeflow::acquisition
