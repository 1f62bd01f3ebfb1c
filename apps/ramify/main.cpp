// SPDX-License-Identifier: GPL-3.0-or-later
// ramify VERB INPUT… -o OUT [options]: the table of verbs. What they do stands in commands_*.cpp.
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

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

}  // namespace

int main(int argc, char** argv) {
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
