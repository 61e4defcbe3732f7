// SPDX-License-Identifier: MIT
#include "network_choice.h"
#include "verbs.h"

namespace crossnav::app {

void AddWatch(CLI::App* verb, WatchOptions& watch) {
  verb->add_flag("--watch", watch.is_on,
                 "Show it in the browser while it goes on: a page on 127.0.0.1, whose address is "
                 "printed");
  verb->add_option("--watch-port", watch.port, "Port of that page; default: any that is free")
      ->check(CLI::Range(0, 65535));
}

void AddServe(CLI::App& app, Options& o) {
  CLI::App* serve = AddVerb(app, o, "serve", "The agent for a live robot, behind a local socket",
                            "crossnav serve --socket /run/user/1000/crossnav.sock --set "
                            "sensor.camera_height_m=0.6 --save-map home.map",
                            [&o](Console& c) { return ServeLive(o.serve, o.common, c); });
  CLI::Option* socket =
      serve
          ->add_option("--socket", o.serve.socket,
                       "Unix domain socket; default: $XDG_RUNTIME_DIR/crossnav.sock, or "
                       "/tmp/crossnav-UID.sock")
          ->type_name("PATH");
  serve->add_option("--port", o.serve.port, "TCP on 127.0.0.1 instead; 0 = any that is free")
      ->check(CLI::Range(0, 65535))
      ->excludes(socket);
  serve
      ->add_option("--perception", o.serve.perception,
                   "networks, or none: maps and explores, and finds nothing")
      ->check(CLI::IsMember({"networks", "none"}));
  serve->add_option("--networks", o.serve.networks, kNetworksHelp)
      ->check(CLI::IsMember({"own", "real"}));
  serve->add_option("--memory", o.serve.memory, "Map file to start from, as --save-map wrote it");
  serve->add_option("--pose", o.serve.pose, kPoseHelp)->check(CLI::IsMember({"given", "unknown"}));
  serve->add_option("--save-map", o.serve.save_map, "Map file to save the memory to at the end");
  AddWatch(serve, o.serve.watch);
}

}  // namespace crossnav::app
