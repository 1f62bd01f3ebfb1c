// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <set>

#include "ramify/core/error.h"
#include "ramify/image/image_container.h"
#include "ramify/image/recipe_xmp.h"

namespace ramify {
namespace {

using namespace std::string_view_literals;

constexpr unsigned kShort = 3;  // the type of 16-bit values
constexpr std::size_t kMaxPages = 10000;
constexpr std::size_t kMaxEntries = 4096;  // of one directory; baseline files have about 20

enum Tag : unsigned {
  kWidth = 256,
  kHeight = 257,
  kBitsPerSample = 258,
  kDescription = 270,
  kStripOffsets = 273,
  kOrientation = 274,
  kStripBytes = 279,
  kTileOffsets = 324,
  kTileBytes = 325,
  kExtraSamples = 338,
  kXmp = 700,
  kIccProfile = 34675,
};

struct Entry {
  unsigned tag = 0;
  unsigned type = 0;
  std::uint64_t count = 0;
  std::uint64_t data = 0;  // where its values start; they may lie outside the file
};

struct Directory {
  std::vector<Entry> entries;
  std::uint64_t next = 0;     // 0 = last
  std::uint64_t next_at = 0;  // where `next` itself is stored
};

unsigned bytes_of_type(unsigned type) {
  constexpr unsigned kBytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
  return type < std::size(kBytes) ? kBytes[type] : 0;
}

// Directories of a TIFF or BigTIFF file, or of an Exif block, which has the same form.
class TiffReader {
 public:
  explicit TiffReader(std::string_view bytes)
      : bytes_(bytes),
        big_endian_(bytes.starts_with("MM")),
        wide_(bytes.size() > 2 && bytes[big_endian_ ? 3 : 2] == '+') {}

  bool holds(std::uint64_t at, std::uint64_t count) const { return at <= bytes_.size() && count <= bytes_.size() - at; }
  std::uint64_t number(std::uint64_t at, unsigned bytes) const {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < bytes; ++i) {
      value = (value << 8) | static_cast<unsigned char>(bytes_[at + (big_endian_ ? i : bytes - 1 - i)]);
    }
    return value;
  }
  unsigned word() const { return wide_ ? 8 : 4; }
  std::optional<std::uint64_t> first_directory() const {
    const unsigned at = wide_ ? 8 : 4;
    if (!holds(at, word())) return std::nullopt;
    return number(at, word());
  }

  // Nothing when the directory does not lie wholly inside the file.
  std::optional<Directory> directory(std::uint64_t at) const {
    const unsigned count_bytes = wide_ ? 8 : 2, entry_bytes = wide_ ? 20 : 12;
    if (!holds(at, count_bytes)) return std::nullopt;
    const std::uint64_t count = number(at, count_bytes);
    if (count > kMaxEntries || !holds(at + count_bytes, count * entry_bytes + word())) return std::nullopt;
    Directory out;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t entry = at + count_bytes + i * entry_bytes;
      Entry read{static_cast<unsigned>(number(entry, 2)), static_cast<unsigned>(number(entry + 2, 2)),
                 number(entry + 4, word()), entry + 4 + word()};
      if (read.count > bytes_.size() || read.count * bytes_of_type(read.type) > word())
        read.data = number(read.data, word());
      out.entries.push_back(read);
    }
    out.next_at = at + count_bytes + count * entry_bytes;
    out.next = number(out.next_at, word());
    return out;
  }

  bool readable(const Entry& entry) const {
    return entry.count <= bytes_.size() && holds(entry.data, entry.count * bytes_of_type(entry.type));
  }
  std::uint64_t value(const Entry& entry, std::uint64_t index = 0) const {
    const unsigned bytes = bytes_of_type(entry.type);
    return number(entry.data + index * bytes, bytes);
  }
  // Sets every byte of a value to 0 but its lowest.
  void put_small(std::string& file, std::uint64_t at, unsigned bytes, char value) const {
    file.replace(at, bytes, bytes, '\0');
    file[at + (big_endian_ ? bytes - 1 : 0)] = value;
  }
  std::string text(const Entry& entry) const { return std::string(bytes_.substr(entry.data, entry.count)); }

 private:
  std::string_view bytes_;
  bool big_endian_;
  bool wide_;
};

const Entry* find(const Directory& directory, unsigned tag) {
  for (const Entry& entry : directory.entries) {
    if (entry.tag == tag && entry.count > 0) return &entry;
  }
  return nullptr;
}

int orientation_of(const TiffReader& reader, const Directory& directory) {
  const Entry* entry = find(directory, kOrientation);
  if (!entry || entry->type != kShort || !reader.readable(*entry)) return 1;
  const std::uint64_t value = reader.value(*entry);
  return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
}

// True when every strip and tile lies inside the file.
bool pixels_inside(const TiffReader& reader, const Directory& directory) {
  const Entry* offsets = find(directory, kStripOffsets);
  const Entry* counts = find(directory, kStripBytes);
  if (!offsets) offsets = find(directory, kTileOffsets), counts = find(directory, kTileBytes);
  if (!offsets || !counts || !reader.readable(*offsets) || !reader.readable(*counts)) return false;
  for (std::uint64_t i = 0; i < std::min(offsets->count, counts->count); ++i) {
    if (!reader.holds(reader.value(*offsets, i), reader.value(*counts, i))) return false;
  }
  return true;
}

// How many pictures the file holds. A chain of directories that bites its own tail is an error, not a hang.
std::size_t count_pages(const TiffReader& reader, std::uint64_t first, const std::string& name) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t at = first; at != 0;) {
    if (!seen.insert(at).second) throw InputError(name, "is damaged: its list of pages runs in a circle");
    if (seen.size() > kMaxPages) throw InputError(name, "holds more than " + std::to_string(kMaxPages) + " pages");
    const std::optional<Directory> page = reader.directory(at);
    if (!page) break;
    at = page->next;
  }
  return seen.size();
}

Size size_of(const TiffReader& reader, const Directory& directory, const std::string& name) {
  const Entry* width = find(directory, kWidth);
  const Entry* height = find(directory, kHeight);
  if (!width || !height || !reader.readable(*width) || !reader.readable(*height)) {
    throw InputError(name, "is not a valid TIFF: it does not say how large its picture is");
  }
  const std::uint64_t w = reader.value(*width), h = reader.value(*height);
  if (w == 0 || h == 0) throw InputError(name, "has no pixels (" + std::to_string(w) + " x " + std::to_string(h) + ")");
  if (w > 0x7FFFFFFF || h > 0x7FFFFFFF) throw InputError(name, "is not a valid TIFF: its size is out of range");
  return {static_cast<int>(w), static_cast<int>(h)};
}

// libvips has no 64-bit samples; say so before it does in its own words.
void check_depth(const TiffReader& reader, const Directory& directory, const std::string& name) {
  const Entry* bits = find(directory, kBitsPerSample);
  if (bits && reader.readable(*bits) && reader.value(*bits) > 32) {
    throw InputError(name,
                     "has " + std::to_string(reader.value(*bits)) + "-bit samples; convert it to 32-bit floats first");
  }
}

void read_metadata(const TiffReader& reader, const Directory& directory, ImageContainer& out) {
  out.orientation = orientation_of(reader, directory);
  const auto text_of = [&](unsigned tag) {
    const Entry* entry = find(directory, tag);
    return entry && bytes_of_type(entry->type) == 1 && reader.readable(*entry) ? reader.text(*entry) : std::string();
  };
  out.profile = text_of(kIccProfile);
  const std::string description = text_of(kDescription);
  if (!description.empty()) out.texts["ImageDescription"] = description.substr(0, description.find('\0'));
  const std::string recipe = recipe_of_xmp(text_of(kXmp));
  if (!recipe.empty()) out.texts[kRecipeKey] = recipe;
}

}  // namespace

ImageContainer read_tiff_container(std::string_view bytes, const std::string& name) {
  const TiffReader reader(bytes);
  const std::optional<std::uint64_t> first = reader.first_directory();
  const std::optional<Directory> directory = first ? reader.directory(*first) : std::nullopt;
  if (!directory) throw InputError(name, "is cut off or damaged: its directory of fields lies outside the file");
  ImageContainer out;
  out.size = size_of(reader, *directory, name);
  check_depth(reader, *directory, name);
  out.truncated = !pixels_inside(reader, *directory);
  read_metadata(reader, *directory, out);
  const std::size_t pages = count_pages(reader, *first, name);
  if (pages > 1) out.warnings.push_back("it holds " + std::to_string(pages) + " pictures; the first was used");
  out.pixels = bytes;
  reader.put_small(out.pixels, directory->next_at, reader.word(), 0);  // the decoder sees one page
  const Entry* extra = find(*directory, kExtraSamples);
  out.associated_alpha = extra && extra->type == kShort && reader.readable(*extra) && reader.value(*extra) == 1;
  if (out.associated_alpha)
    reader.put_small(out.pixels, extra->data, 2, 2);  // we divide in floats, libvips would round
  return out;
}

int exif_orientation(std::string_view exif) {
  if (!exif.starts_with("II*\0"sv) && !exif.starts_with("MM\0*"sv)) return 1;
  const TiffReader reader(exif);
  const std::optional<std::uint64_t> first = reader.first_directory();
  const std::optional<Directory> directory = first ? reader.directory(*first) : std::nullopt;
  return directory ? orientation_of(reader, *directory) : 1;
}

}  // namespace ramify
