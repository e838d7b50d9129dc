#include <map>
#include <mutex>
#include <set>

#include "transport/participant.hpp"
#include "transport/text_message.hpp"

namespace bodeflow::transport {
namespace {

using middleware::Flow;
using middleware::Guid;
using middleware::Type;

constexpr std::size_t kLongestText = std::size_t{1} << 20;

/// The latest text of each writer that lives.
class Notes final : public middleware::ReaderSink {
 public:
  bool room() override { return true; }
  void sample(std::span<const std::byte> bytes) override { staged_ = text_of(bytes, kLongestText); }
  void from(const Guid& writer) override {
    if (!staged_) return;
    const std::lock_guard lock(mutex_);
    notes_[writer] = std::move(*staged_);
  }
  void matched(const Guid& writer, bool yes) override {
    const std::lock_guard lock(mutex_);
    // The text of a writer that is only late stays, for when it is heard again: it will not come twice.
    if (yes) {
      alive_.insert(writer);
    } else {
      alive_.erase(writer);
    }
  }
  std::vector<std::string> texts(const std::optional<Guid>& own) {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> texts;
    for (const auto& [writer, text] : notes_) {
      if (alive_.contains(writer) && writer != own) texts.push_back(text);
    }
    return texts;
  }

 private:
  std::mutex mutex_;
  std::optional<std::string> staged_;
  std::map<Guid, std::string> notes_;
  std::set<Guid> alive_;
};

class DdsBoard final : public Board {
 public:
  DdsBoard(std::shared_ptr<Participant> participant, std::string topic)
      : participant_(std::move(participant)), topic_(std::move(topic)), notes_(std::make_shared<Notes>()) {}

  tl::expected<void, Failure> open(bool writes) {
    auto* node = participant_->node(kFar);
    if (writes) {
      auto writer = node->writer({topic_, Type::message, Flow::present}, {});
      if (!writer) return tl::unexpected(writer.error());
      writer_ = std::move(*writer);
    }
    auto reader = node->reader({topic_, Type::message, Flow::present}, notes_);
    if (!reader) return tl::unexpected(reader.error());
    reader_ = std::move(*reader);
    return {};
  }
  tl::expected<void, Failure> say(const std::string& text) override {
    const auto failed = [&](Failure::Kind kind, const std::string& why) {
      return tl::unexpected(Failure{kind, "board '" + topic_ + "': " + why});
    };
    if (!writer_) return failed(Failure::Kind::refused, "opened for reading only");
    if (text.size() > kLongestText) return failed(Failure::Kind::refused, "a text longer than 1 MiB");
    const auto bytes = text_message(text);
    const std::span<const std::byte> parts[] = {bytes};
    for (int attempt = 0; attempt < 10; ++attempt) {
      if (writer_->write(parts)) return {};
    }
    return failed(Failure::Kind::library, "Fast DDS took no text");
  }
  std::vector<std::string> texts() override { return notes_->texts(writer_ ? std::optional(writer_->guid()) : std::nullopt); }

 private:
  std::shared_ptr<Participant> participant_;
  std::string topic_;
  std::shared_ptr<Notes> notes_;
  std::unique_ptr<middleware::Writer> writer_;
  std::unique_ptr<middleware::Reader> reader_;
};

}  // namespace

tl::expected<std::unique_ptr<Board>, Failure> open_board(const std::shared_ptr<Participant>& participant,
                                                         const std::string& topic, bool writes) {
  auto board = std::make_unique<DdsBoard>(participant, topic);
  if (auto done = board->open(writes); !done) return tl::unexpected(done.error());
  return board;
}

}  // namespace bodeflow::transport
