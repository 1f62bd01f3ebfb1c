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

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-';
}

std::vector<const CLI::App*> all_verbs(const CLI::App& root) {
  return root.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? "" : " Did you mean " + near + "?";
}

// What is wrong with the first of the words that a verb does not know.
std::string unknown_word(const CLI::App& root, const CLI::App& verb) {
  const std::vector<std::string> left = verb.remaining();
  const auto option = std::find_if(left.begin(), left.end(), is_option);
  if (option == left.end()) return "'" + printable(left.front(), 60) + "' is one word too many.";
  const std::string name = option->substr(0, option->find('='));
  std::string message = "unknown option " + printable(name, 60) + ".";
  const std::string near = did_you_mean(name, option_names(verb));
  if (!near.empty()) return message + near;
  std::string others;
  for (const CLI::App* other : all_verbs(root)) {
    const std::vector<std::string> names = option_names(*other);
    if (std::find(names.begin(), names.end(), name) != names.end())
      others += (others.empty() ? "" : ", ") + other->get_name();
  }
  return others.empty() ? message : message + " It is an option of " + others + ".";
}

std::string no_verb(const CLI::App& root, const std::vector<std::string>& words) {
  if (words.empty() || is_option(words.front())) return "name a verb first, such as synth or trace.";
  std::vector<std::string> names;
  for (const CLI::App* verb : all_verbs(root)) names.push_back(verb->get_name());
  return "there is no verb '" + printable(words.front(), 60) + "'." + did_you_mean(words.front(), names);
}

int usage_error(const CLI::App& root, const Chosen& chosen, const CLI::ParseError& error, const std::vector<std::string>& words) {
  std::string message = printable(error.what(), 400);
  const auto verbs = root.get_subcommands();
  if (verbs.empty())
    message = no_verb(root, words);
  else if (dynamic_cast<const CLI::ExtrasError*>(&error) && !verbs.back()->remaining().empty())
    message = unknown_word(root, *verbs.back());
  else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) {
    const bool twice = message.find("At Most") != std::string::npos;
    message = message.substr(0, message.find(':')) + (twice ? ": is given more than once" : ": a value must follow");
  }
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
  for (const CLI::Option* option : root.get_subcommands().back()->get_options()) {
    const std::vector<std::string>& values = option->results();
    if (option->get_name() == "--palette" || std::find(values.begin(), values.end(), "") == values.end()) continue;
    return report_error(chosen.shared, ExitCode::Usage,
                        option->get_name() + ": is empty; give it a value or leave it out");
  }
  return run_verb(chosen.shared, chosen.work);
}
