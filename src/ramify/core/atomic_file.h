// SPDX-License-Identifier: GPL-3.0-or-later
// The only way ramify writes files: whole or not at all. The bytes go to a temporary file in the same folder; commit()
// flushes it to the disk, renames it over the final name and flushes the folder. Whatever happens before that leaves the
// old file as it was, and the temporary file is removed - also on Ctrl-C (remove_unfinished_files).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ramify {

class AtomicFile {
 public:
  // Opens the temporary file. Throws OutputError when the folder is missing or not writable, or when `path` is a folder,
  // a symbolic link or a device.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&& other) noexcept;

  void write(std::string_view bytes);  // throws OutputError (disk full, I/O error)
  void commit();                       // throws OutputError; at most once

  // For libraries that must write by themselves: the temporary file's name. The file already exists and is empty.
  const std::string& temporary_path() const { return temporary_; }

 private:
  void abandon() noexcept;
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  std::string temporary_;
  int descriptor_ = -1;
  int slot_ = -1;
  bool done_ = false;
};

// Writes one file at once.
void write_file(const std::string& path, std::string_view bytes);

// The whole content of a regular file of at most `limit` bytes. Throws InputError for a missing file, a folder, a FIFO,
// a device or a socket, LimitError when it is larger.
std::string read_file(const std::string& path, std::size_t limit);

// Unlinks every temporary file that is still open. Async-signal-safe: meant for the second Ctrl-C and for SIGTERM.
void remove_unfinished_files() noexcept;

}  // namespace ramify
