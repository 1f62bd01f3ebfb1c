// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include <algorithm>
#include <charconv>

namespace ramify::app {
namespace {

// A whole number written in plain digits; "1e3", "0x10", "-1" and blanks are refused.
void read_seed(const std::string& text, std::uint64_t& seed) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    throw OptionError("seed", "'" + printable(text, 60) + "'", "expected a whole number from 0 to 18446744073709551615");
  }
}

void add_field(CLI::App& app, const std::shared_ptr<std::vector<OptionField>>& fields, const std::string& group) {
  const OptionField& first = fields->front();
  const auto assign = [fields](const std::string& value) {
    for (OptionField& field : *fields) set_text(field, value);
  };
  CLI::Option* option = nullptr;
  if (const auto* value = std::get_if<bool*>(&first.value)) {
    const bool turns_off = **value;
    option = app.add_flag_function((turns_off ? "--no-" : "--") + first.name, [assign, turns_off](std::int64_t given) {
      assign((given > 0) == turns_off ? "false" : "true");
    });
    option->description((turns_off ? "Switch off: " : "") + first.help);
  } else {
    option = app.add_option_function<std::string>("--" + first.name, assign);
    std::string kind = "TEXT";
    if (const auto* choices = std::get_if<ChoiceRef>(&first.value)) {
      kind.clear();
      for (const std::string& name : choices->names) kind += (kind.empty() ? "" : "|") + name;
    } else if (!std::holds_alternative<std::string*>(first.value)) {
      kind = first.unit.empty() ? "NUMBER" : first.unit;
    }
    option->type_name(kind);
    const std::string standard = get_text(first);
    option->description(first.help + (standard.empty() ? "" : " [" + standard + "]"));
    option->trigger_on_parse();
  }
  option->group(group);
}

}  // namespace

LoadLimits SharedOptions::load_limits() const {
  LoadLimits limits;
  limits.pixels = limit_pixels;
  limits.allow_truncated = allow_truncated;
  return limits;
}

void FieldFlags::add(CLI::App& app, const std::vector<OptionField>& fields, const std::string& group) {
  for (const OptionField& field : fields) {
    auto& entry = fields_[field.name];
    if (entry) {
      entry->push_back(field);
      continue;
    }
    entry = std::make_shared<std::vector<OptionField>>(1, field);
    add_field(app, entry, group);
  }
}

void add_shared(CLI::App& app, SharedOptions& shared) {
  const std::string group = "Shared options";
  app.add_option_function<std::string>("--seed", [&](const std::string& t) { read_seed(t, shared.seed); },
                                       "Seed of all randomness; the same seed gives the same bytes [1]")
      ->type_name("N")->group(group);
  std::vector<OptionField> fields{
      number("threads", shared.threads, 0, 1024, "N", "Threads to use, 0 = all processors; never changes the result."),
      number("limit-pixels", shared.limit_pixels, 1, 1e12, "px", "Largest picture read or written."),
      number("limit-memory", shared.limit_memory, 0, 1e9, "MiB", "Largest address space, 0 = no limit."),
      number("timeout", shared.timeout, 0, 1e9, "s", "Give up after this time, 0 = never."),
      text("timings", shared.timings, "Write the time of every stage to this JSON file."),
      text("debug-dir", shared.debug_dir, "Write every intermediate into this folder."),
      flag("no-clobber", shared.no_clobber, "Skip outputs that exist already."),
      flag("json", shared.json, "Print results as JSON on standard output."),
      flag("quiet", shared.quiet, "Print errors only."),
      flag("allow-other-photo", shared.allow_other_photo, "Use a photo whose sha256 differs from the annotation's."),
      flag("allow-truncated", shared.allow_truncated, "Read what is left of a cut picture file.")};
  FieldFlags().add(app, fields, group);
  app.add_flag("-v,--verbose", shared.verbose, "Print notes and the time of every stage.")->group(group);
  app.add_option("--progress", shared.progress, "How to show progress [auto]")
      ->check(CLI::IsMember({"auto", "bar", "json", "none"}))->type_name("auto|bar|json|none")->group(group);
}

Size parse_size(const std::string& name, const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec == std::errc() && height.ptr == end && size.width > 0 && size.height > 0) return size;
  }
  throw OptionError(name, "'" + printable(text, 60) + "'", "expected WIDTHxHEIGHT in px, such as 1600x1076");
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = 1 + word.size() / 3;  // farther away is another word, not a slip
  for (const std::string& candidate : known) {
    std::vector<std::size_t> row(candidate.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      std::size_t diagonal = row[0]++;
      for (std::size_t j = 1; j < row.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1)});
        diagonal = above;
      }
    }
    if (row.back() <= best_distance && (best.empty() || row.back() < best_distance)) {
      best = candidate;
      best_distance = row.back();
    }
  }
  return best;
}

}  // namespace ramify::app
