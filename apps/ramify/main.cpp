// SPDX-License-Identifier: GPL-3.0-or-later
// ramify VERB INPUT… -o OUT [options]: the table of verbs. What they do stands in commands_*.cpp.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "commands.h"
#include "ramify/core/version.h"

namespace {

using namespace ramify;
using namespace ramify::app;

// "--tropsim" → " Did you mean --tropism?", from the words the parser knows at this place.
std::string suggestion(const CLI::App& root, const std::vector<std::string>& words) {
  const CLI::App* verb = &root;
  for (const CLI::App* sub : root.get_subcommands()) verb = sub;
  std::vector<std::string> known;
  if (verb == &root) {
    for (const CLI::App* sub : root.get_subcommands([](const CLI::App*) { return true; })) known.push_back(sub->get_name());
  }
  for (const CLI::Option* option : verb->get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : words) {
    const std::string near = nearest_word(word.substr(0, word.find('=')), known);
    if (!near.empty() && near != word) return " Did you mean " + near + "?";
  }
  return "";
}

int usage_error(const CLI::App& root, const Chosen& chosen, const CLI::ParseError& error, const std::vector<std::string>& words) {
  std::string message = printable(error.what(), 400);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) || dynamic_cast<const CLI::RequiredError*>(&error)) {
    message += suggestion(root, words);
  }
  const auto verbs = root.get_subcommands();
  message += " (see ramify " + (verbs.empty() ? std::string() : verbs.back()->get_name() + " ") + "--help)";
  return report_error(chosen.shared, ExitCode::Usage, message);
}

// Pictures come and go by the hundred. By default the system gets back the memory of each and has to clear it anew, small
// page by small page, for the next: a fifth of a run's processor time. So what is freed is kept, all threads share it, and
// the first part of it is asked for in large pages. Only addresses are taken in advance. All of this may fail, without harm.
void keep_freed_memory() {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr int kMostOfAPicture = 32 << 20, kAhead = 512 << 20, kLaterAhead = 16 << 20;  // bytes
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  mallopt(M_MMAP_THRESHOLD, kMostOfAPicture);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TOP_PAD, kAhead);
  const auto start = (reinterpret_cast<std::size_t>(sbrk(0)) + kLargePage - 1) / kLargePage * kLargePage;
  void* volatile more_than_there_is = std::malloc(kLargePage);
  std::free(more_than_there_is);
  const auto end = reinterpret_cast<std::size_t>(sbrk(0)) / kLargePage * kLargePage;
  if (start < end) madvise(reinterpret_cast<void*>(start), end - start, MADV_HUGEPAGE);
  mallopt(M_TOP_PAD, kLaterAhead);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  Chosen chosen;
  CLI::App root("ramify - new photographs of branching things from one example", "ramify");
  root.set_version_flag("--version", "ramify " RAMIFY_VERSION);
  root.require_subcommand(1);
  root.get_formatter()->column_width(34);
  for (const auto add : {add_synth, add_grow, add_render, add_trace, add_rectify, add_complete, add_exemplar, add_dendrite,
                         add_stylize, add_moss, add_figure, add_paint, add_compare, add_convert, add_replay, add_info}) {
    add(root, chosen);
  }
  root.footer("A first picture:\n  ramify synth builtin:lightning --seed 7 -o bolt.png\n"
              "Your own photo:\n  ramify trace photo.jpg -o photo.ramify.json\n"
              "  ramify synth photo.ramify.json --count 3 -o new.png\n"
              "Exit codes: 0 ok, 1 bug, 2 usage, 3 bad input, 4 output, 5 limit, 130 Ctrl-C, 143 SIGTERM.");
  std::vector<std::string> words(argv + 1, argv + argc);
  chosen.shared.json = std::find(words.begin(), words.end(), "--json") != words.end();  // also for usage errors
  try {
    root.parse(argc, argv);
  } catch (const CLI::Success& done) {
    return root.exit(done);
  } catch (const CLI::ParseError& error) {
    return usage_error(root, chosen, error, words);
  } catch (const Error& error) {
    return report_error(chosen.shared, error.code(), error.what());
  }
  return run_verb(chosen.shared, chosen.work);
}
