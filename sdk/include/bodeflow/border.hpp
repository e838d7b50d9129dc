#pragma once

#include <bodeflow/block_base.hpp>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// Runs `work`; an exception of whatever type becomes BF_FAILED with its text at the host.
template <class Work>
std::int32_t guarded(const bf_host* host, Work&& work) noexcept {
  try {
    work();
    return BF_OK;
  } catch (const Services::HostRefused&) {
  } catch (const std::exception& e) {
    host->error(host, e.what());
  } catch (...) {
    host->error(host, "an exception that is not derived from std::exception");
  }
  return BF_FAILED;
}

/// The description of block class B, made and checked at the first call. Throws Failure if it is wrong.
template <class B>
const BlockType& block_type() {
  static const BlockType type = [] {
    BlockDraft draft;
    Describe d(draft);
    B::describe(d);
    return BlockType(std::move(draft));
  }();
  return type;
}

/// A block of class B behind the C functions of bf_block; no exception leaves it.
template <class B>
struct Border {
  static_assert(std::is_base_of_v<Block, B>, "blocks derive from bodeflow::Block");

  static std::int32_t create(const bf_factory*, const bf_host* host, void* made) noexcept {
    return guarded(host, [&] {
      auto border = std::make_unique<Border>(*host);
      bf_block block{};
      block.struct_size = sizeof block;
      block.configure = configure;
      block.resolve = resolve;
      block.activate = activate;
      block.process = process;
      block.change = change;
      block.finish = finish;
      block.reset = reset;
      block.deactivate = deactivate;
      block.destroy = destroy;
      block.extension = extension;
      block.self = border.release();
      *static_cast<bf_block*>(made) = block;
    });
  }

  explicit Border(const bf_host& host) : host_(&host), type_(&block_type<B>()), values_(type_->draft().parameters.size()) {
    base().services_ = Services(host);
  }

 private:
  static Border& of(void* self) { return *static_cast<Border*>(self); }
  Block& base() { return block_; }
  Parameters parameters() const { return {type_->draft().parameters, values_}; }

  static std::int32_t configure(void* self, const bf_parameter_value* values, std::uint32_t count) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      if (count != b.values_.size())
        fail("the host gives " + std::to_string(count) + " parameters; described: " + std::to_string(b.values_.size()));
      for (std::uint32_t i = 0; i < count; ++i) b.store(i, values[i]);
      b.configured_ = b.values_;
      b.changed_ = false;
      b.base().configure(b.parameters());
    });
  }

  void store(std::uint32_t i, const bf_parameter_value& value) {
    const ParameterDraft& described = type_->draft().parameters.at(i);
    if (value.type != described.type) fail("the host gives parameter '" + described.name + "' as another type than described");
    values_[i].assign(value);
  }

  static std::int32_t resolve(void* self, bf_resolution* resolution) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      Facts facts(*b.type_, *resolution);
      b.base().resolve(facts);
      b.facts_.emplace(std::move(facts));
      b.facts_->write(*resolution);
    });
  }

  static std::int32_t activate(void* self, const bf_activation* a) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      b.base().activate({a->max_count, a->seed, Rate(a->rate), a->realtime != 0, static_cast<int>(a->vector_level)});
    });
  }

  static std::int32_t process(void* self, bf_process* p) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      Io io(*p, *b.host_);
      if (p->message_count != 0) b.receive(*p, io);
      if (p->count != 0) b.base().process(io);
    });
  }

  void receive(const bf_process& p, Io& io) {
    for (std::uint32_t i = 0; i < p.message_count; ++i) {
      const bf_message& m = p.messages[i];
      io.begin_record(m.time);
      base().receive(static_cast<int>(m.port), RecordView(*m.record), io);
    }
    io.end_records();
  }

  static std::int32_t change(void* self, std::uint32_t parameter, const bf_parameter_value* value) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      if (parameter >= b.values_.size()) fail("the host changes a parameter that is not described");
      b.changed_ = true;
      b.store(parameter, *value);
      b.base().change(b.parameters());
    });
  }

  static std::int32_t finish(void* self, bf_process* p) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      Io io(*p, *b.host_);
      b.base().finish(io);
    });
  }

  static std::int32_t reset(void* self) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      if (b.changed_) {  // live parameters go back as well
        b.values_ = b.configured_;
        b.changed_ = false;
        b.base().change(b.parameters());
      }
      b.base().reset();
    });
  }

  static void deactivate(void* self) noexcept {
    Border& b = of(self);
    guarded(b.host_, [&] { b.base().deactivate(); });
  }

  static void destroy(void* self) noexcept {
    Border* b = static_cast<Border*>(self);
    const bf_host* host = b->host_;
    guarded(host, [&] { delete b; });
  }

  static std::int32_t advise(void* self, const bf_resolution* resolution, void* context, Advice::Tell tell) noexcept {
    Border& b = of(self);
    return guarded(b.host_, [&] {
      Advice advice(tell, context);
      b.base().advise(Facts(*b.type_, *resolution, true), advice);
    });
  }

  static const void* extension(void*, const char* id) noexcept {
    static constexpr bf_advice advice{sizeof(bf_advice), advise};
    return std::string_view(id) == BF_EXTENSION_ADVICE ? &advice : nullptr;
  }

  B block_;
  const bf_host* host_;
  const BlockType* type_;
  std::vector<StoredValue> values_;      ///< as they are now
  std::vector<StoredValue> configured_;  ///< as configure gave them
  bool changed_ = false;
  std::optional<Facts> facts_;  ///< keeps alive what the host was given
};

}  // namespace v0
}  // namespace bodeflow
