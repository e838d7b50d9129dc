#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow {

/// All bytes of a file. Error: "can't be read: ...".
tl::expected<std::vector<std::byte>, std::string> file_bytes(const std::filesystem::path& path);

}  // namespace bodeflow
