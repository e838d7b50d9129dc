#include <atomic>
#include <condition_variable>
#include <deque>

#include "transport/participant.hpp"
#include "transport/progress.hpp"
#include "transport/text_message.hpp"

namespace bodeflow::transport {
namespace {

using middleware::Flow;
using middleware::Guid;
using middleware::Type;
using std::chrono::steady_clock;

constexpr std::size_t kMostQueued = 64;
constexpr std::size_t kLongestText = std::size_t{16} << 20;

class Letters final : public middleware::ReaderSink {
 public:
  bool room() override {
    const std::lock_guard lock(mutex_);
    left_ = texts_.size() >= kMostQueued;
    return !left_;
  }
  void sample(std::span<const std::byte> bytes) override {
    auto text = text_of(bytes, kLongestText);
    if (!text) return;
    const std::lock_guard lock(mutex_);
    texts_.push_back(std::move(*text));
    came_.notify_one();
  }
  void matched(const Guid& /*writer*/, bool /*yes*/) override {}

  std::optional<std::string> take(double seconds, bool& pull) {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !texts_.empty(); });
    pull = std::exchange(left_, false);
    if (texts_.empty()) return std::nullopt;
    auto text = std::move(texts_.front());
    texts_.pop_front();
    return text;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<std::string> texts_;
  bool left_ = false;
};

class DdsMailbox final : public Mailbox {
 public:
  DdsMailbox(std::shared_ptr<Participant> participant, std::shared_ptr<Letters> letters,
             std::unique_ptr<middleware::Reader> reader)
      : participant_(std::move(participant)), letters_(std::move(letters)), reader_(std::move(reader)) {}
  std::optional<std::string> receive(double seconds) override {
    bool pull = false;
    auto text = letters_->take(seconds, pull);
    if (pull) reader_->pull();
    return text;
  }

 private:
  std::shared_ptr<Participant> participant_;
  std::shared_ptr<Letters> letters_;
  std::unique_ptr<middleware::Reader> reader_;
};

class Recipients final : public middleware::WriterSink {
 public:
  void matched(const Guid& /*reader*/, bool yes) override {
    const std::lock_guard lock(mutex_);
    count_ += yes ? 1 : -1;
    changed_.notify_all();
  }
  bool wait(steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    return changed_.wait_until(lock, until, [&] { return count_ > 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int count_ = 0;
};

Failure not_delivered(const std::string& topic, const std::string& why, double seconds) {
  return {Failure::Kind::tolerance, "mailbox '" + topic + "': " + why + " within " + seconds_text(seconds)};
}

}  // namespace

tl::expected<std::unique_ptr<Mailbox>, Failure> open_mailbox(const std::shared_ptr<Participant>& participant,
                                                             const std::string& topic) {
  auto letters = std::make_shared<Letters>();
  auto reader = participant->node(kFar)->reader({topic, Type::message, Flow::all}, letters);
  if (!reader) return tl::unexpected(reader.error());
  return std::make_unique<DdsMailbox>(participant, std::move(letters), std::move(*reader));
}

tl::expected<void, Failure> post(const std::shared_ptr<Participant>& participant, const std::string& topic,
                                 const std::string& text, double seconds) {
  if (text.size() > kLongestText) {
    return tl::unexpected(Failure{Failure::Kind::refused, "mailbox '" + topic + "': a text of " + std::to_string(text.size()) +
                                                              " bytes (allowed: " + std::to_string(kLongestText) + ")"});
  }
  const auto until =
      steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(seconds));
  auto recipients = std::make_shared<Recipients>();
  auto writer = participant->node(kFar)->writer({topic, Type::message, Flow::all}, recipients);
  if (!writer) return tl::unexpected(writer.error());
  if (!recipients->wait(until)) return tl::unexpected(not_delivered(topic, "nobody reads it", seconds));
  const auto bytes = text_message(text);
  const std::span<const std::byte> parts[] = {bytes};
  while (!(*writer)->write(parts)) {
    if (steady_clock::now() >= until) return tl::unexpected(not_delivered(topic, "the text was not sent", seconds));
  }
  while (!(*writer)->acknowledged(0.05)) {
    if (steady_clock::now() >= until) return tl::unexpected(not_delivered(topic, "no receipt came", seconds));
  }
  if (!recipients->wait(steady_clock::now())) return tl::unexpected(not_delivered(topic, "its reader has gone", seconds));
  return {};
}

}  // namespace bodeflow::transport
