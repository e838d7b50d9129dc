#include <unistd.h>

#include <random>

#include "transport/credit.hpp"
#include "transport/ledger.hpp"
#include "transport/shelf.hpp"

namespace bodeflow::transport {
namespace {

using middleware::Flow;
using middleware::Guid;
using middleware::Type;
using std::chrono::steady_clock;

constexpr double kIdle = 0.002;  // s without a message until the writer is told what was taken
constexpr double kSlice = 0.05;  // s between two questions whether to go on
constexpr std::chrono::milliseconds kGrantPeriod{20};

std::uint64_t random_number() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device();
}

class Arrivals final : public middleware::ReaderSink {
 public:
  Arrivals(std::shared_ptr<Shelf> shelf, Way way) : shelf_(std::move(shelf)), way_(way) {}
  bool room() override { return shelf_->room(way_); }
  void sample(std::span<const std::byte> bytes) override { shelf_->put(way_, bytes); }
  void matched(const Guid& writer, bool yes) override { shelf_->writer_matched(way_, writer, yes); }

 private:
  std::shared_ptr<Shelf> shelf_;
  Way way_;
};

class DdsInlet final : public Inlet {
 public:
  DdsInlet(std::shared_ptr<Participant> participant, const Edge& edge)
      : participant_(std::move(participant)), edge_(edge), shelf_(std::make_shared<Shelf>(edge)), id_(random_number()) {}

  tl::expected<void, Failure> open() {
    for (const auto way : {kFar, kNear}) {
      if (way == kNear && !has_near(*participant_, edge_)) continue;
      if (auto done = open(way); !done) return done;
    }
    return {};
  }

  tl::expected<Message, Failure> next(const GoOn& go_on) override {
    if (auto item = ready()) return hand_over(std::move(*item));
    const Progress::Wait wait(shelf_->progress());
    double patience = kIdle;
    while (true) {
      if (auto item = waiting_ ? ready() : shelf_->take(patience)) return hand_over(std::move(*item));
      patience = kSlice;
      grant();
      if (go_on && !go_on()) return tl::unexpected(shelf_->failure(Failure::Kind::stopped));
      if (shelf_->progress().too_long()) return tl::unexpected(shelf_->failure(Failure::Kind::tolerance));
    }
  }

  tl::expected<std::optional<Message>, Failure> poll(double seconds) override {
    auto item = ready();
    if (!item) {
      const Progress::Wait wait(shelf_->progress());
      item = shelf_->take(std::min(seconds, kIdle));
      if (!item) grant();
      if (!item && seconds > kIdle) item = shelf_->take(seconds - kIdle);
    }
    if (!item) return std::optional<Message>();
    auto message = hand_over(std::move(*item));
    if (!message) return tl::unexpected(message.error());
    return std::optional<Message>(std::move(*message));
  }

  EdgeState state() const override {
    EdgeState state;
    shelf_->tell(state);
    return state;
  }

 private:
  struct Side {
    std::shared_ptr<Arrivals> arrivals;
    std::unique_ptr<middleware::Reader> reader;
    std::unique_ptr<middleware::Writer> credits;
  };

  tl::expected<void, Failure> open(Way way) {
    auto& side = sides_[way];
    const auto topic = topic_on(way, edge_.topic);
    const auto flow = !edge_.lossless ? Flow::latest : edge_.keeps_last ? Flow::last : Flow::all;
    side.arrivals = std::make_shared<Arrivals>(shelf_, way);
    auto reader = participant_->node(way)->reader({topic, Type::message, flow}, side.arrivals);
    if (!reader) return tl::unexpected(reader.error());
    side.reader = std::move(*reader);
    shelf_->reader_is(way, side.reader->guid());
    if (!edge_.lossless) return {};
    auto credits = participant_->node(way)->writer({topic + ".credit", Type::credit, Flow::last}, {});
    if (!credits) return tl::unexpected(credits.error());
    side.credits = std::move(*credits);
    taken_.stream = edge_.stream;
    tell(way);
    return {};
  }

  /// What is here already.
  std::optional<Shelf::Item> ready() {
    if (waiting_) return std::exchange(waiting_, std::nullopt);
    return shelf_->take(0.0);
  }

  /// A message after a gap waits for the next call: this one tells the gap.
  tl::expected<Message, Failure> hand_over(Shelf::Item item) {
    if (item.gap > 0) {
      auto gap = shelf_->missing(item);
      item.gap = 0;
      waiting_ = std::move(item);
      return tl::unexpected(std::move(gap));
    }
    const auto left = shelf_->claim_left();
    for (const auto way : {kFar, kNear}) {
      if (left[way] && sides_[way].reader) sides_[way].reader->pull();
    }
    taken_ = {item.way, item.message.header.stream, item.message.header.epoch, item.message.header.sequence + 1};
    owed_ += item.message.payload.size() + Ledger::kOverhead;
    if (owed_ >= edge_.queue_bytes / 8 || steady_clock::now() - granted_ >= kGrantPeriod) grant();
    return std::move(item.message);
  }

  void grant() {
    if (!edge_.lossless || owed_ == 0) return;
    tell(taken_.way);
    owed_ = 0;
    granted_ = steady_clock::now();
  }

  void tell(Way way) {
    Credit credit;
    credit.stream = taken_.stream;
    credit.inlet = id_;
    credit.epoch = taken_.epoch;
    credit.reader = sides_[way].reader->guid();
    credit.near = has_near(*participant_, edge_);
    credit.taken = taken_.count;
    const auto bytes = encode(credit);
    const std::span<const std::byte> parts[] = {bytes};
    static_cast<void>(sides_[way].credits->write(parts));
  }

  struct Taken {
    Way way = kFar;
    std::uint64_t stream = 0;  ///< an open edge learns it from the first message
    std::uint32_t epoch = 0;
    std::uint64_t count = 0;
  };

  std::shared_ptr<Participant> participant_;
  const Edge edge_;
  std::shared_ptr<Shelf> shelf_;
  const std::uint64_t id_;
  std::array<Side, kWays> sides_;
  std::optional<Shelf::Item> waiting_;
  Taken taken_;
  std::uint64_t owed_ = 0;  // cost of what was taken and not told
  steady_clock::time_point granted_ = steady_clock::now();
};

}  // namespace

tl::expected<std::unique_ptr<Inlet>, Failure> open_inlet(const std::shared_ptr<Participant>& participant, const Edge& edge) {
  auto inlet = std::make_unique<DdsInlet>(participant, edge);
  if (auto done = inlet->open(); !done) return tl::unexpected(done.error());
  return inlet;
}

}  // namespace bodeflow::transport
