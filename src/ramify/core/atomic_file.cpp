// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "ramify/core/error.h"

namespace ramify {
namespace {

// Temporary names that a signal handler may have to unlink: fixed storage, a slot is live while `used` is 2.
struct Slot {
  std::atomic<int> used{0};  // 0 free, 1 being filled, 2 live
  std::array<char, 4300> name{};
};
std::array<Slot, 64> g_slots;

int claim_slot(const std::string& name) {
  for (std::size_t i = 0; i < g_slots.size(); ++i) {
    int free = 0;
    if (name.size() + 1 > g_slots[i].name.size() || !g_slots[i].used.compare_exchange_strong(free, 1)) continue;
    std::memcpy(g_slots[i].name.data(), name.c_str(), name.size() + 1);
    g_slots[i].used = 2;
    return static_cast<int>(i);
  }
  return -1;  // more open outputs than slots: those few are still removed by their destructors
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

std::string reason(int error) {
  switch (error) {
    case ENOSPC: case EDQUOT: return "the disk is full; free some space and run again";
    case EROFS: return "the file system is read-only; choose another folder";
    case EACCES: case EPERM: return "no permission to write there; choose another folder";
    case ENOENT: return "the folder does not exist; create it first";
    case ENOTDIR: return "a part of the path is not a folder";
    case ENAMETOOLONG: return "the name is too long";
    case EMFILE: case ENFILE: return "too many open files";
    default: return std::strerror(error);
  }
}

}  // namespace

void AtomicFile::fail(const std::string& what) const {
  throw OutputError(printable(path_, 300), "cannot " + what + ": " + reason(errno));
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  struct stat info {};
  if (path_.empty()) throw OutputError("output", "the name is empty");
  if (::lstat(path_.c_str(), &info) == 0) {
    const std::string shown = printable(path_, 300);
    if (S_ISLNK(info.st_mode)) throw OutputError(shown, "is a symbolic link; name the file itself");
    if (S_ISDIR(info.st_mode)) throw OutputError(shown, "is a folder; name a file in it");
    if (!S_ISREG(info.st_mode)) throw OutputError(shown, "is not a regular file");
  } else if (errno == ENAMETOOLONG) {
    fail("write");
  }
  const std::string folder = folder_of(path_);
  temporary_ = folder + "/.ramify.part-XXXXXX";
  descriptor_ = ::mkostemp(temporary_.data(), O_CLOEXEC);
  if (descriptor_ < 0) {
    temporary_.clear();
    fail("write");
  }
  slot_ = claim_slot(temporary_);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor_, 0666 & ~mask);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)), slot_(std::exchange(other.slot_, -1)),
      done_(std::exchange(other.done_, true)) {}

AtomicFile::~AtomicFile() { abandon(); }

void AtomicFile::abandon() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!done_ && !temporary_.empty()) ::unlink(temporary_.c_str());
  if (slot_ >= 0) g_slots[std::exchange(slot_, -1)].used = 0;
  done_ = true;
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("write " + std::to_string(bytes.size()) + " bytes");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void AtomicFile::commit() {
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail("write");
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("write");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("write");
  done_ = true;
  abandon();
  const int folder = ::open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

std::string read_file(const std::string& path, std::size_t limit) {
  const std::string shown = printable(path, 300);
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) {
    const char* why = errno == ENOENT ? "no such file" : errno == EACCES ? "no permission to read it" : std::strerror(errno);
    throw InputError(shown, why);
  }
  if (S_ISDIR(info.st_mode)) throw InputError(shown, "is a folder, not a file");
  if (!S_ISREG(info.st_mode)) throw InputError(shown, "is not a regular file (a pipe, device or socket)");
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw InputError(shown, errno == EACCES ? "no permission to read it" : std::strerror(errno));
  std::string bytes;
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t n = ::read(descriptor, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    const int error = errno;
    if (n <= 0 || bytes.size() + static_cast<std::size_t>(n) > limit) {
      ::close(descriptor);
      if (n < 0) throw InputError(shown, std::strerror(error));
      if (n > 0) throw LimitError(shown + ": larger than the limit of " + std::to_string(limit) + " bytes");
      return bytes;
    }
    bytes.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

void remove_unfinished_files() noexcept {
  for (Slot& slot : g_slots) {
    if (slot.used == 2) ::unlink(slot.name.data());
  }
}

}  // namespace ramify
