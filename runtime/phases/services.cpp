#include "phases/services.hpp"

#include <map>
#include <mutex>
#include <vector>

namespace bodeflow::phases {

struct Services::State {
  struct Message {
    std::string block;
    int level;
    std::string text;
  };
  Echo echo;
  std::mutex mutex;
  record::RunDirectory* directory = nullptr;
  std::vector<Message> messages;
  std::vector<std::pair<std::string, std::string>> inputs;
  std::map<std::string, const void*, std::less<>> provided;
};

Services::Services(Echo echo) : state_(std::make_shared<State>()), host_(std::make_shared<HostServices>()) {
  state_->echo = std::move(echo);
  host_->log = [state = state_](const std::string& block, int level, const std::string& text) {
    const std::lock_guard lock(state->mutex);
    if (state->echo) state->echo(block, level, text);
    if (state->directory != nullptr)
      state->directory->log(block, level, text);
    else
      state->messages.push_back({block, level, text});
  };
  host_->note_input = [state = state_](const std::string& block, const std::string& path) {
    const std::lock_guard lock(state->mutex);
    if (state->directory != nullptr)
      state->directory->note_input(block, path);
    else
      state->inputs.emplace_back(block, path);
  };
  host_->output_path = [state = state_](const std::string& block,
                                        const std::string& name) -> tl::expected<std::string, std::string> {
    const std::lock_guard lock(state->mutex);
    if (state->directory == nullptr) return std::string();
    return state->directory->output_path(block, name);
  };
  host_->extension = [state = state_](std::string_view id) -> const void* {
    const std::lock_guard lock(state->mutex);
    const auto found = state->provided.find(id);
    return found == state->provided.end() ? nullptr : found->second;
  };
}

void Services::provide(std::string id, const void* service) {
  const std::lock_guard lock(state_->mutex);
  state_->provided[std::move(id)] = service;
}

void Services::attach(record::RunDirectory& directory) {
  const std::lock_guard lock(state_->mutex);
  state_->directory = &directory;
  for (const auto& message : state_->messages) directory.log(message.block, message.level, message.text);
  for (const auto& [block, path] : state_->inputs) directory.note_input(block, path);
  state_->messages.clear();
  state_->inputs.clear();
}

}  // namespace bodeflow::phases
