#include "commands/methods.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "graph/problem.hpp"

namespace bodeflow::tools {
namespace {

std::vector<const BlockDescription*> methods_of(const Registry& registry) {
  std::vector<const BlockDescription*> methods;
  for (const auto& id : registry.ids()) {
    const BlockDescription* block = registry.find(id);
    if (std::find(block->roles.begin(), block->roles.end(), "identifier") != block->roles.end()) methods.push_back(block);
  }
  return methods;
}

std::string family(const BlockDescription& block) { return block.id.substr(0, block.id.find('.')); }
std::string last_part(const BlockDescription& block) { return block.id.substr(block.id.rfind('.') + 1); }

template <class Test>
std::vector<const BlockDescription*> those(const std::vector<const BlockDescription*>& methods, Test test) {
  std::vector<const BlockDescription*> found;
  std::copy_if(methods.begin(), methods.end(), std::back_inserter(found), [&](const auto* block) { return test(*block); });
  return found;
}

}  // namespace

std::string method_list(const Registry& registry) {
  std::string text;
  for (const auto* block : methods_of(registry)) text += fmt::format("\n  {:<28} {}", block->id, block->summary);
  return text.empty() ? "\n  none: no plugin that was found has one" : text;
}

tl::expected<const BlockDescription*, std::string> method_named(const Registry& registry, const std::string& word) {
  const auto methods = methods_of(registry);
  const auto by_id = those(methods, [&](const auto& block) { return block.id == word; });
  if (by_id.size() == 1) return by_id.front();
  const auto in_family = those(methods, [&](const auto& block) { return family(block) == word; });
  const auto called_model = those(in_family, [&](const auto& block) { return last_part(block) == "model"; });
  if (called_model.size() == 1) return called_model.front();
  if (in_family.size() == 1) return in_family.front();
  const auto by_part = those(methods, [&](const auto& block) { return last_part(block) == word; });
  if (by_part.size() == 1) return by_part.front();

  std::vector<std::string> known;
  for (const auto* block : methods) {
    known.push_back(block->id);
    known.push_back(family(*block));
  }
  const bool several = in_family.size() + by_part.size() > 1;
  return tl::unexpected(fmt::format("--method '{}': {}{}; methods:{}", word,
                                    several ? "several methods are called so" : "no such method",
                                    several ? "" : did_you_mean(word, known), method_list(registry)));
}

}  // namespace bodeflow::tools
