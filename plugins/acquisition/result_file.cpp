#include "result_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "json_record.hpp"

namespace bodeflow::acquisition {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;
constexpr const char* kUsual = "identify";  ///< what the command of that name calls its result

Expected<std::string> text_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return unexpected(file.string() + ": can't be read: " + error.message());
  if (size > kMostBytes) return unexpected(file.string() + ": more than 1 GiB; no result.json of a run is that long");
  std::ifstream in(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) return unexpected(file.string() + ": can't be read");
  return text;
}

std::string place_of(const std::string& file, const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte == 0 ? 0 : byte - 1, text.size()));
  const auto line = std::count(text.begin(), end, '\n') + 1;
  const auto last = std::find(std::make_reverse_iterator(end), text.rend(), '\n');
  const auto column = std::distance(last.base(), end) + 1;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

Expected<Json> parsed(const std::string& file, const std::string& text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    return unexpected(place_of(file, text, error.byte) + "is no JSON");
  } catch (const Json::exception& error) {
    return unexpected(file + ": is no JSON that can be read: " + error.what());
  }
}

std::string type_of(const Json& record) {
  if (!record.is_object()) return "no record";
  const auto type = record.find("type");
  return type == record.end() || !type->is_string() ? "no record" : type->get<std::string>();
}

std::string listed(const Json& results) {
  std::string text;
  for (const auto& [name, record] : results.items()) text += (text.empty() ? "" : ", ") + name + " (" + type_of(record) + ")";
  return text.empty() ? "nothing" : text;
}

/// The key of the record that is wanted.
Expected<std::string> chosen(const std::string& file, const Json& results, const std::string& name, const std::string& type) {
  if (!name.empty()) {
    const auto found = results.find(name);
    if (found == results.end()) return unexpected(file + ": no result '" + name + "'; it has " + listed(results));
    if (!type.empty() && type_of(*found) != type)
      return unexpected(file + ": result '" + name + "' is of type '" + type_of(*found) + "'; needed: " + type);
    return name;
  }
  std::vector<std::string> keys;
  for (const auto& [key, record] : results.items())
    if (type.empty() || type_of(record) == type) keys.push_back(key);
  if (keys.size() == 1) return keys.front();
  if (std::find(keys.begin(), keys.end(), kUsual) != keys.end()) return std::string(kUsual);
  const std::string wanted = type.empty() ? "record" : "record of type '" + type + "'";
  if (keys.empty()) return unexpected(file + ": no " + wanted + "; it has " + listed(results));
  return unexpected(file + ": more than one " + wanted + "; say which by its name: " + listed(results));
}

}  // namespace

Expected<ResultRecord> read_result(const std::string& path, const std::string& name, const std::string& type) {
  std::error_code error;
  std::filesystem::path place(path);
  if (std::filesystem::is_directory(place, error)) {
    place /= "result.json";
    if (!std::filesystem::exists(place, error))
      return unexpected(path + ": a folder without result.json; needed: a run directory");
  }
  const std::string file = place.string();
  const auto text = text_of(place);
  if (!text) return unexpected(text.error().text);
  const auto json = parsed(file, *text);
  if (!json) return unexpected(json.error().text);
  if (!json->is_object() || !json->contains("bodeflow") || !json->contains("results") || !(*json)["results"].is_object())
    return unexpected(file + ": is no result.json of a run: 'bodeflow' and 'results' are missing");
  if ((*json)["bodeflow"] != 1) return unexpected(file + ": results of version " + (*json)["bodeflow"].dump() + "; read is 1");
  const auto key = chosen(file, (*json)["results"], name, type);
  if (!key) return unexpected(key.error().text);
  auto record = record_of_json((*json)["results"][*key]);
  if (!record) return unexpected(file + ": result '" + *key + "': " + record.error().text);
  const auto status = json->find("status");
  return ResultRecord{file, *key, status != json->end() && status->is_string() ? status->get<std::string>() : "",
                      std::move(*record)};
}

}  // namespace bodeflow::acquisition
