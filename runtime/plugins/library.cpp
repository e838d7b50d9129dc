#include "plugins/library.hpp"

#include <bodeflow/utf8.hpp>

#include "plugins/describe.hpp"
#include "plugins/elf_note.hpp"
#include "plugins/host.hpp"

#define BOOST_DLL_USE_STD_FS
#include <dlfcn.h>
#include <fmt/format.h>

#include <boost/dll/shared_library.hpp>
#include <string_view>
#include <system_error>

namespace bodeflow {

struct Library::State {
  // Order matters: factories and descriptors live in the library, which goes last.
  boost::dll::shared_library library;
  Host host{"", nullptr};  // of `factories`: a plugin may keep it as long as it is loaded
  PluginDescription description;
  std::map<std::string, const bf_factory*> factories;  // by id
};

namespace {

constexpr std::uint32_t kMostFactories = 4096;

using Result = tl::expected<void, std::string>;

tl::unexpected<std::string> failure(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

tl::expected<const bf_plugin*, std::string> find_plugin(const boost::dll::shared_library& library) {
  if (!library.has(BF_PLUGIN_SYMBOL)) return failure("exports no symbol '" BF_PLUGIN_SYMBOL "'");
  const bf_plugin& plugin = library.get<const bf_plugin>(BF_PLUGIN_SYMBOL);
  if (plugin.magic != BF_PLUGIN_MAGIC) return failure("its symbol '" BF_PLUGIN_SYMBOL "' begins with a wrong magic number");
  if (std::string why = abi_problem(plugin.abi_major, plugin.abi_minor); !why.empty()) return failure(std::move(why));
  if (plugin.struct_size < sizeof(bf_plugin)) {
    return failure(fmt::format("its bf_plugin has {} bytes, at least {} expected", plugin.struct_size, sizeof(bf_plugin)));
  }
  if (plugin.name == nullptr || plugin.version == nullptr) return failure("its name or version is a null pointer");
  for (const char* text : {plugin.name, plugin.version, plugin.build}) {
    if (text != nullptr && !is_text(text)) return failure("its name, version or build is not UTF-8");
  }
  if (plugin.factories == nullptr) return failure("its function 'factories' is a null pointer");
  return &plugin;
}

/// The factories' words on failure; an exception that a plugin without the SDK's C++ layer lets out counts as one.
tl::expected<const bf_factory* const*, std::string> call_factories(const bf_plugin& plugin, Host& host, std::uint32_t& count) {
  const bf_factory* const* factories = nullptr;
  try {
    factories = plugin.factories(&host.c(), &count);
  } catch (...) {
    return failure("its function 'factories' let an exception out");
  }
  if (factories == nullptr) return failure("has no factories: " + host.take_error());
  if (count > kMostFactories) return failure(fmt::format("names {} factories, at most {} expected", count, kMostFactories));
  return factories;
}

/// Reads the factory's descriptor by `read` into `descriptions`. `what` is the kind in words.
template <class C, class Description>
Result add(const bf_factory& factory, const std::string& what, tl::expected<Description, std::string> (*read)(const C&),
           std::vector<Description>& descriptions) {
  if (factory.struct_size < sizeof(bf_factory)) {
    return failure(fmt::format("a factory has {} bytes, at least {} expected", factory.struct_size, sizeof(bf_factory)));
  }
  if (factory.id == nullptr) return failure("a factory's id is a null pointer");
  const std::string id = factory.id;
  if (factory.descriptor == nullptr) return failure(what + " '" + id + "': its descriptor is a null pointer");
  if (factory.create == nullptr) return failure(what + " '" + id + "': its function 'create' is a null pointer");
  auto description = read(*static_cast<const C*>(factory.descriptor));
  if (!description) return failure(description.error());
  if (description->id != id) return failure(what + " '" + description->id + "': its factory is named '" + id + "'");
  descriptions.push_back(std::move(*description));
  return {};
}

/// False for a kind of a later host.
tl::expected<bool, std::string> enter(const bf_factory& factory, PluginDescription& plugin) {
  const std::string_view kind = factory.kind;
  Result added;
  if (kind == "block") {
    added = add<bf_block_descriptor, BlockDescription>(factory, "block", describe, plugin.blocks);
  } else if (kind == "effect") {
    added = add<bf_effect_descriptor, EffectDescription>(factory, "effect", describe, plugin.effects);
  } else if (kind == "base_model") {
    added = add<bf_block_descriptor, BlockDescription>(factory, "base model", describe_base_model, plugin.base_models);
  } else {
    return false;
  }
  if (!added) return failure(added.error());
  return true;
}

}  // namespace

Library::Library() : state_(std::make_unique<State>()) {}
Library::~Library() = default;

const PluginDescription& Library::description() const { return state_->description; }

tl::expected<std::unique_ptr<Library>, std::string> Library::load(const std::filesystem::path& file) {
  namespace dll = boost::dll;
  std::unique_ptr<Library> made(new Library);
  State& state = *made->state_;
  std::error_code error;
  dlerror();
  state.library.load(file, error, dll::load_mode::rtld_now | dll::load_mode::rtld_local);
  if (error) {
    const char* reason = dlerror();
    std::string text = reason == nullptr ? error.message() : reason;
    if (const std::string prefix = file.string() + ": "; text.rfind(prefix, 0) == 0) text.erase(0, prefix.size());
    return failure("can't be loaded: " + text);
  }
  const auto plugin = find_plugin(state.library);
  if (!plugin) return failure(plugin.error());
  state.description.name = (*plugin)->name;
  state.description.version = (*plugin)->version;
  state.description.build = (*plugin)->build == nullptr ? "" : (*plugin)->build;
  std::uint32_t count = 0;
  const auto factories = call_factories(**plugin, state.host, count);
  if (!factories) return failure(factories.error());
  for (std::uint32_t i = 0; i < count; ++i) {
    const bf_factory* factory = (*factories)[i];
    if (factory == nullptr || factory->kind == nullptr) return failure("a factory or its kind is a null pointer");
    const auto entered = enter(*factory, state.description);
    if (!entered) return failure(entered.error());
    if (*entered && !state.factories.emplace(factory->id, factory).second)
      return failure(fmt::format("gives {} '{}' twice", factory->kind, factory->id));
  }
  return made;
}

tl::expected<bf_block, std::string> Library::create(const std::string& id, const bf_host& host) const {
  bf_block block{};
  if (auto made = create_part("block", id, host, &block); !made) return failure(made.error());
  return block;
}

Result Library::create_part(const std::string& kind, const std::string& id, const bf_host& host, void* made) const {
  const auto found = state_->factories.find(id);
  if (found == state_->factories.end() || found->second->kind != kind) return failure(fmt::format("gives no {} '{}'", kind, id));
  std::int32_t result = BF_FAILED;
  try {
    result = found->second->create(found->second, &host, made);
  } catch (...) {
    return failure("an exception left the plugin's function 'create'");
  }
  if (result != BF_OK) return failure(Host::error_of(host));
  return {};
}

}  // namespace bodeflow
