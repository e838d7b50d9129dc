#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::record {

/// Makes one data.h5 of several of one run, each of which holds other streams and message outputs. `keep`: which blocks' data is
/// taken over. Error: why not, with the path.
tl::expected<void, std::string> join_data(const std::vector<std::filesystem::path>& files, const std::filesystem::path& into,
                                          const std::function<bool(const std::string& block)>& keep);

}  // namespace bodeflow::record
