// SPDX-License-Identifier: MIT
// The program's command line. Exit 0 done, 1 bad data or a failed run, 2 usage.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>

#include "crossnav/core/nearest.h"
#include "crossnav/core/version.h"
#include "verbs.h"

namespace crossnav::app {

CLI::App* AddVerb(CLI::App& parent, Options& options, const char* name, const char* what,
                  const char* example, Command command) {
  CLI::App* verb = parent.add_subcommand(name, what);
  verb->footer(std::string("Example:\n  ") + example);
  verb->add_flag("--json", options.common.json, "One JSON document on stdout, logs on stderr");
  verb->add_flag("--quiet", options.common.quiet, "No logs and no progress");
  verb->add_option("--config", options.common.config_file,
                   "Settings (TOML); default: the paper's numbers, our navigator")
      ->type_name("FILE");
  verb->add_option("--set", options.common.overrides, "Override a setting; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->callback([&options, command = std::move(command)] { options.command = command; });
  return verb;
}

namespace {

/// Message for an unknown verb or option, with its nearest neighbour; empty if all are known.
std::string MistypedName(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* verb = &app;
  bool is_value = false;  // may be the value of the option before it
  for (const std::string& word : words) {
    if (word == "--") return {};
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(0, word.find('='));
      if (verb->get_option_no_throw(name) == nullptr) {
        std::vector<std::string> names;
        for (const CLI::Option* option : verb->get_options())
          for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
        return "unknown option \"" + name + "\"" + DidYouMean(name, names);
      }
      is_value = word.find('=') == std::string::npos;
      continue;
    }
    const auto verbs = verb->get_subcommands([](const CLI::App*) { return true; });
    std::vector<std::string> names;
    for (const CLI::App* known : verbs) names.push_back(known->get_name());
    const auto found = std::find(names.begin(), names.end(), word);
    if (found != names.end()) {
      verb = verbs[static_cast<std::size_t>(found - names.begin())];
    } else if (!names.empty() && !is_value) {
      return "unknown verb \"" + word + "\"" + DidYouMean(word, names);
    }
    is_value = false;
  }
  return {};
}

int Main(int argc, char** argv) {
  CLI::App app("crossnav: sequential object-goal navigation in multi-floor houses", "crossnav");
  app.set_version_flag("--version", CROSSNAV_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  Options options;
  AddSceneVerbs(app, options);
  AddRunVerbs(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string mistake = MistypedName(app, {argv + 1, argv + argc});
    std::fprintf(stderr, "crossnav: %s\nSee: crossnav --help\n",
                 mistake.empty() ? error.what() : mistake.c_str());
    return 2;
  }
  Console console(options.common.json, options.common.quiet);
  // Settings are checked for all verbs, including verbs that do not use them.
  std::vector<std::string> warnings;
  const auto config = LoadConfig(options.common, "full", &warnings);
  for (const std::string& warning : warnings) console.Log("crossnav: warning: " + warning);
  auto ok = config ? options.command(console) : Result<void>(tl::unexpected(config.error()));
  if (ok) ok = console.CheckPrinted();
  console.EndProgress();
  if (ok) return 0;
  console.Fail(ok.error());
  return 1;
}

}  // namespace
}  // namespace crossnav::app

int main(int argc, char** argv) {
  try {
    return crossnav::app::Main(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("crossnav: not enough memory for this input\n", stderr);
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crossnav: %s\n", error.what());
    return 1;
  }
}
