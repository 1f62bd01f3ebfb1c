// SPDX-License-Identifier: GPL-3.0-or-later
#include "outputs.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "arguments.h"
#include "ramify/core/error.h"

namespace ramify::app {
namespace fs = std::filesystem;
namespace {

bool same_place(const std::string& a, const std::string& b) {
  struct stat first {}, second {};
  return fs::path(a).filename() == fs::path(b).filename() && stat(folder_of(a).c_str(), &first) == 0 &&
         stat(folder_of(b).c_str(), &second) == 0 && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

}  // namespace

std::string numbered(const std::string& path, int index) {
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", index);
  const std::size_t slash = path.rfind('/');
  const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
  std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || dot <= name) dot = path.size();
  return path.substr(0, dot) + number + path.substr(dot);
}

std::string extension_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

bool has_extension(const std::string& path, const std::vector<std::string>& allowed) {
  return std::find(allowed.begin(), allowed.end(), extension_of(path)) != allowed.end();
}

void check_extension(const std::string& option, const std::string& path, const std::vector<std::string>& allowed) {
  if (has_extension(path, allowed)) return;
  std::string list;
  for (const std::string& extension : allowed) list += (list.empty() ? "" : ", ") + extension;
  throw OptionError(option, "'" + printable(path, 200) + "'", "the name must end in one of " + list);
}

void check_outputs(const SharedOptions& shared, std::vector<std::string> outputs,
                   const std::vector<std::string>& inputs) {
  if (!shared.timings.empty()) outputs.push_back(shared.timings);
  for (const std::string& output : outputs) {
    const std::string shown = printable(output, 300);
    struct stat out {};
    if (lstat(output.c_str(), &out) == 0) {
      if (S_ISLNK(out.st_mode)) throw OutputError(shown, "is a symbolic link; name the file itself");
      if (S_ISDIR(out.st_mode)) throw OutputError(shown, "is a folder; name a file in it");
      for (const std::string& input : inputs) {
        struct stat in {};
        if (stat(input.c_str(), &in) == 0 && in.st_dev == out.st_dev && in.st_ino == out.st_ino) {
          throw OutputError(shown, "is also an input; inputs are never overwritten, choose another name");
        }
      }
    } else if (errno == ENAMETOOLONG) {
      throw OutputError(shown, "the name is too long");
    }
    struct stat folder {};
    if (stat(folder_of(output).c_str(), &folder) != 0 || !S_ISDIR(folder.st_mode)) {
      throw OutputError(shown, "the folder does not exist; create it first");
    }
    const bool kept = shared.no_clobber && file_exists(output);
    if (!kept && access(folder_of(output).c_str(), W_OK | X_OK) != 0) {
      throw OutputError(shown, errno == EROFS ? "the file system is read-only; choose another folder"
                                              : "no permission to write there; choose another folder");
    }
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (same_place(outputs[i], outputs[j])) throw OutputError(printable(outputs[i], 300), "is named for two outputs");
    }
  }
}

bool file_exists(const std::string& path) {
  struct stat info {};
  return lstat(path.c_str(), &info) == 0;
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw OutputError(printable(path, 300), "cannot make the folder: " + error.message());
}

}  // namespace ramify::app
