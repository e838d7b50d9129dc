#include "open_table.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "csv.hpp"
#include "hdf5_table.hpp"
#include "mat_table.hpp"
#include "uff_table.hpp"
#include "wav_table.hpp"

namespace bodeflow::acquisition {
namespace {

using Opened = Expected<std::unique_ptr<TableReader>>;

Opened open_text(const std::string& path) {
  auto source = open_file(path);
  if (!source) return unexpected(path + ": " + source.error().text);
  return open_csv(std::move(*source), path);
}

Opened open_universal(const std::string& path) {
  return open_uff([path] { return open_file(path); }, path);
}

Opened open_matlab(const std::string& path) {
  const auto hdf5 = is_mat73(path);
  if (!hdf5) return {Unexpected<Error>{hdf5.error()}};
  if (*hdf5) return open_hdf5(path);
  return open_mat([path] { return open_file(path); }, path);
}

struct Format {
  const char* ending;
  Opened (*open)(const std::string&);
};

constexpr std::array kFormats = {
    Format{".csv", open_text},   Format{".txt", open_text},      Format{".tsv", open_text},      Format{".dat", open_text},
    Format{".h5", open_hdf5},    Format{".hdf5", open_hdf5},     Format{".mat", open_matlab},    Format{".wav", open_sound},
    Format{".flac", open_sound}, Format{".uff", open_universal}, Format{".unv", open_universal},
};

}  // namespace

std::string table_endings() {
  std::string text;
  for (const Format& f : kFormats) text += (text.empty() ? "" : ", ") + std::string(f.ending);
  return text;
}

Expected<std::unique_ptr<TableReader>> open_table(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  const auto* const format = std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return ending == f.ending; });
  if (format == kFormats.end()) return unexpected(path + ": ending '" + ending + "'; read are " + table_endings());
  auto bytes = open_file(path);
  if (!bytes) return unexpected(path + ": " + bytes.error().text);
  char first = 0;
  const auto got = (*bytes)->read(&first, 1);
  if (!got) return unexpected(path + ": " + got.error().text);
  if (*got == 0) return unexpected(path + ": empty file");
  return format->open(path);
}

}  // namespace bodeflow::acquisition
