#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/ports.hpp>
#include <bodeflow/record.hpp>
#include <complex>
#include <cstdint>
#include <cstring>
#include <span>

namespace bodeflow {
inline namespace v0 {

/// What a block moves in one call: `count()` firings from `position()` on. Reading and writing allocate nothing, look
/// nothing up and throw nothing.
class Io {
 public:
  Io(bf_process& process, const bf_host& host) : p_(&process), host_(&host), offset_(process.count) {}

  /// Firings in this call.
  std::size_t count() const { return static_cast<std::size_t>(p_->count); }
  /// Index of the first.
  std::uint64_t position() const { return p_->position; }
  /// In `receive`: when the record was made by its producer's clock, in seconds.
  double record_time() const { return record_time_; }

  /// False for an optional input that nothing is connected to.
  template <class T>
  bool connected(In<T> port) const {
    return p_->inputs[port.index].channel_count != 0;
  }
  template <class T>
  int channels(In<T> port) const {
    return static_cast<int>(p_->inputs[port.index].channel_count);
  }
  template <class T>
  int channels(Out<T> port) const {
    return static_cast<int>(p_->outputs[port.index].channel_count);
  }
  /// BF_F64 or BF_C64.
  template <class T>
  std::uint32_t element(In<T> port) const {
    return p_->inputs[port.index].element;
  }
  template <class T>
  std::uint32_t element(Out<T> port) const {
    return p_->outputs[port.index].element;
  }

  /// Channel c of an input: count x samples values.
  template <class T>
  std::span<const T> read(In<T> port, int c = 0) const {
    return span<const T>(p_->inputs[port.index], c);
  }
  /// Channel c of an output, to be written whole.
  template <class T>
  std::span<T> write(Out<T> port, int c = 0) const {
    return span<T>(p_->outputs[port.index], c);
  }
  /// The same for a port of either type, after a look at `element`.
  template <class T>
  std::span<const T> read(In<Any> port, int c = 0) const {
    return span<const T>(p_->inputs[port.index], c);
  }
  template <class T>
  std::span<T> write(Out<Any> port, int c = 0) const {
    return span<T>(p_->outputs[port.index], c);
  }

  /// Sends a record: `offset` firings after `position()` (0..count), the end of the call where it is left out, in `receive`
  /// the moment of the record received. Throws Failure when memory is out or the offset is beyond the call.
  void emit(MessageOut port, const RecordBuilder& record) { emit(port, record, offset_); }
  void emit(MessageOut port, const RecordBuilder& record, std::uint64_t offset) {
    bf_record* made = make(port, record.size(), offset);
    record.write(made->bytes);
    p_->emit(p_, static_cast<std::uint32_t>(port.index), made, offset);
  }
  /// Sends a copy of a record that was received.
  void emit(MessageOut port, const RecordView& record) { emit(port, record, offset_); }
  void emit(MessageOut port, const RecordView& record, std::uint64_t offset) {
    const auto bytes = record.bytes();
    bf_record* made = make(port, bytes.size(), offset);
    std::memcpy(made->bytes, bytes.data(), bytes.size());
    p_->emit(p_, static_cast<std::uint32_t>(port.index), made, offset);
  }

  /// Of a source: its stream ended after k <= count firings of this call.
  void end_after(std::uint64_t k) {
    if (k > p_->count) fail("the stream ends after " + std::to_string(k) + " of " + std::to_string(p_->count) + " firings");
    p_->done = k;
  }

  /// For the border: says that a record is being received.
  void begin_record(double time_s) {
    record_time_ = time_s;
    offset_ = 0;
  }
  void end_records() { offset_ = p_->count; }

 private:
  template <class T>
  static std::span<T> span(const bf_stream& stream, int c) {
    return {static_cast<T*>(stream.channels[c]) + stream.offset, static_cast<std::size_t>(stream.count)};
  }

  bf_record* make(MessageOut port, std::uint64_t size, std::uint64_t offset) const {
    if (offset > p_->count) fail(std::string("record on '") + port.name + "' is placed beyond the end of the call");
    bf_record* record = host_->record_create(host_, size);
    if (record == nullptr) fail("no memory for a record of " + std::to_string(size) + " bytes");
    return record;
  }

  bf_process* p_;
  const bf_host* host_;
  std::uint64_t offset_;
  double record_time_ = 0.0;
};

}  // namespace v0
}  // namespace bodeflow
