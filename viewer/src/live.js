// SPDX-License-Identifier: MIT
// Follows a run in progress: the server's events (docs/formats/replay.md, "Live") make a replay
// that grows. The page shows the latest step until the user goes back.
import { bytesOfBase64 } from "./data.js";
import { byId, hideNotice, showNotice } from "./panels.js";

/// Content of a page's file before the first step. `pieces`: voxel runs of the head.
export function replayOf(head) {
  const { info, depth_max_m, states, runs } = head;
  return {
    info, depth_max_m, states, is_complete: true, stages: [], steps: [], images: [], depths: [],
    sights: [], maps: [], graphs: [], pieces: runs ? [bytesOfBase64(runs)] : [],
  };
}

/// Adds a step; returns its voxel runs, after the head's runs for the first step.
export function addStep(replay, event) {
  const { step, image, depth, sight, maps, runs, graph } = event;
  replay.steps.push(step);
  replay.images.push(image);
  replay.depths.push(depth);
  replay.sights.push(sight);
  replay.maps.push(maps);
  if (graph) replay.graphs.push({ index: replay.steps.length - 1, graph });
  // A robot's goals are unknown in advance.
  while (replay.info.goals.length <= step.goal_index) replay.info.goals.push(step.goal);
  replay.info.goals[step.goal_index] = step.goal;
  return [...replay.pieces.splice(0), bytesOfBase64(runs)];
}

/// The button with the state of the connection; it returns to the latest step.
class LiveButton {
  constructor() {
    this.button = byId("live");
    this.button.hidden = false;
    this.button.addEventListener("click", () => this.app?.seek(Infinity));
    this.text = "waiting";
  }

  show() {
    const isFollowing = this.app?.isAtEnd() && this.text === "live";
    this.button.classList.toggle("on", Boolean(isFollowing));
    this.button.dataset.state = this.text;
    this.button.textContent = { live: "● Live", ended: "■ Ended", lost: "○ Lost", waiting: "… Waiting" }[
      this.text];
  }

  is(text) {
    this.text = text;
    this.show();
  }
}

/// `makeApp(replay)` shows a replay with its first step; its result has beginLive(replay),
/// isAtEnd(), grow(pieces), seek(index) and onSeek.
export function watchLive(url, makeApp) {
  const source = new EventSource(url), button = new LiveButton();
  let replay = null, app = null, shown = null, fresh = [], isDue = false;

  const update = () => {
    isDue = false;
    if (!replay?.steps.length) return;
    if (shown !== replay) {
      if (app) app.beginLive(replay);
      else {
        app = button.app = makeApp(replay);
        app.onSeek = () => button.show();
      }
      shown = replay;
    }
    hideNotice();
    app.grow(fresh.splice(0));
    if (replay.isOver) showNotice("The run has ended. The page keeps what it has shown.");
    button.show();
  };
  const changed = () => {
    if (!isDue) requestAnimationFrame(update);
    isDue = true;
  };
  const on = (kind, act) => source.addEventListener(kind, (event) => {
    act(JSON.parse(event.data));
    changed();
  });

  showNotice("Waiting for the first step.");
  on("head", (head) => {
    replay = replayOf(head);
    fresh = [];
  });
  on("step", (event) => fresh.push(addStep(replay, event)));
  on("stage", (stage) => replay.stages.push(stage));
  on("end", () => {
    source.close();
    if (replay) replay.isOver = true;
    button.is("ended");
  });
  source.onopen = () => button.is("live");
  source.onerror = () => {
    button.is("lost");  // the browser reconnects by itself, unless it was refused
    if (source.readyState === EventSource.CLOSED) showNotice("The server refuses; load the page again.");
  };
}
