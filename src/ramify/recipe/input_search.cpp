// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <tuple>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/recipe.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestInput = std::size_t{1} << 30;
constexpr std::size_t kMostFiles = 10000;  // looked at in one folder

// The digest of a regular file, empty when it cannot be read. Remembered until the file's size or date changes.
std::string digest_of(const fs::path& path) {
  using Key = std::tuple<std::string, std::uintmax_t, fs::file_time_type>;
  static std::mutex guard;
  static std::map<Key, std::string> known;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  const std::uintmax_t size = fs::file_size(path, error);
  const fs::file_time_type date = error ? fs::file_time_type{} : fs::last_write_time(path, error);
  if (error || size > kLargestInput) return {};
  const Key key{path.string(), size, date};
  const std::lock_guard<std::mutex> lock(guard);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  try {
    return known[key] = sha256_hex(read_file(path.string(), kLargestInput));
  } catch (const Error&) {
    return known[key] = {};
  }
}

// The regular files of a folder that end like `hint`, in the order of their names.
std::vector<fs::path> candidates(const fs::path& folder, const fs::path& hint) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end;
       !error && it != end; it.increment(error)) {
    if (paths.size() >= kMostFiles) break;
    if (it->path().extension() == hint.extension() && it->is_regular_file(error)) paths.push_back(it->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::optional<std::string> find_in(const fs::path& folder, const RecipeInput& input, bool& other_content) {
  const fs::path hinted = folder / input.file;
  const std::string digest = digest_of(hinted);
  if (digest == input.sha256) return hinted.string();
  other_content = other_content || !digest.empty();
  for (const fs::path& path : candidates(folder, input.file)) {
    if (digest_of(path) == input.sha256) return path.string();
  }
  return std::nullopt;
}

}  // namespace

std::string find_input(const RecipeInput& input, const std::vector<std::string>& folders) {
  if (input.sha256.empty()) return input.file;  // one of ramify's own exemplars
  bool other_content = false;
  std::string searched;
  for (const std::string& folder : folders) {
    const std::string named = folder.empty() ? "." : folder;
    if (const auto path = find_in(named, input, other_content)) return *path;
    searched += "in " + printable(named, 300) + ", ";
  }
  const char* photos = std::getenv("RAMIFY_PHOTOS");
  const bool has_photos = photos && *photos;
  if (has_photos) {
    if (const auto path = find_in(photos, input, other_content)) return *path;
  }
  throw InputError(printable(input.file, 300),
                   "the " + input.role + " with sha256 " + input.sha256.substr(0, 12) + "… was not found " + searched +
                       "in RAMIFY_PHOTOS" + (has_photos ? " (" + printable(photos, 300) + ")" : " (which is not set)") +
                       (other_content ? "; the file of this name has other content" : "") +
                       "; name the folder that holds it with --inputs");
}

}  // namespace ramify
