// SPDX-License-Identifier: MIT
// The program's command line. Exit 0 done, 1 bad data or a failed run, 2 usage.
#include <CLI/CLI.hpp>
#include <exception>

#include "verbs.h"

namespace crossnav::app {

CLI::App* AddVerb(CLI::App& parent, Options& options, const char* name, const char* what,
                  const char* example, Command command) {
  CLI::App* verb = parent.add_subcommand(name, what);
  verb->footer(std::string("Example:\n  ") + example);
  verb->add_flag("--json", options.common.json, "One JSON document on stdout, logs on stderr");
  verb->add_flag("--quiet", options.common.quiet, "No logs and no progress");
  verb->add_option("--config", options.common.config_file, "Settings (TOML); empty = the paper's")
      ->type_name("FILE");
  verb->add_option("--set", options.common.overrides, "Override a setting; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->callback([&options, command = std::move(command)] { options.command = command; });
  return verb;
}

namespace {

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
    std::fprintf(stderr, "crossnav: %s\nSee: crossnav --help\n", error.what());
    return 2;
  }
  Console console(options.common.json, options.common.quiet);
  const auto ok = options.command(console);
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
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crossnav: %s\n", error.what());
    return 1;
  }
}
