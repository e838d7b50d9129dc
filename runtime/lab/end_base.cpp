#include "lab/end_base.hpp"

#include <fmt/format.h>

#include <exception>

namespace bodeflow::lab {

/// What a bf_block of an end points to.
struct End::Functions {
  const bf_host* host;
  std::shared_ptr<End> end;

  static Functions& of(void* self) { return *static_cast<Functions*>(self); }

  std::int32_t said(const tl::expected<void, std::string>& done) const {
    if (done) return BF_OK;
    host->error(host, done.error().c_str());
    return BF_FAILED;
  }

  template <class Call>
  std::int32_t guarded(Call&& call) const noexcept {
    try {
      return said(call());
    } catch (const std::exception& e) {
      host->error(host, e.what());
      return BF_FAILED;
    }
  }

  static std::int32_t process(void* self, bf_process* call) {
    return of(self).guarded([&] { return of(self).end->process(*static_cast<execute::BlockRun*>(call->context), *call); });
  }
  static std::int32_t finish(void* self, bf_process* call) {
    return of(self).guarded([&] { return of(self).end->finish(*static_cast<execute::BlockRun*>(call->context)); });
  }

  static bf_block block(const bf_host& host, std::shared_ptr<End> end) {
    bf_block block{};
    block.struct_size = sizeof block;
    block.self = new Functions{&host, std::move(end)};
    block.configure = [](void*, const bf_parameter_value*, std::uint32_t) -> std::int32_t { return BF_OK; };
    block.resolve = [](void*, bf_resolution*) -> std::int32_t { return BF_OK; };
    block.activate = [](void*, const bf_activation*) -> std::int32_t { return BF_OK; };
    block.process = process;
    block.change = [](void*, std::uint32_t, const bf_parameter_value*) -> std::int32_t { return BF_OK; };
    block.finish = finish;
    block.reset = [](void*) -> std::int32_t { return BF_OK; };
    block.deactivate = [](void*) {};
    block.destroy = [](void* self) { delete static_cast<Functions*>(self); };
    return block;
  }
};

MadeEnd End::wrap(const std::string& name, const BlockDescription& type, std::shared_ptr<End> end) {
  MadeEnd made;
  made.instance = Instance::own(name, type, [&](const bf_host& host) { return Functions::block(host, end); });
  made.end = std::move(end);
  return made;
}

std::string text_of(const Cut& cut, const transport::Failure& failure) {
  return fmt::format("connection {} between hosts: {}", cut.name, failure.text);
}

}  // namespace bodeflow::lab
