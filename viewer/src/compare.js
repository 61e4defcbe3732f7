// SPDX-License-Identifier: MIT
// Two replays of one episode: their first difference, and the other run's state at the current
// step.
import { words } from "./data.js";
import { byId } from "./panels.js";

/// Equal for steps with the same pose and action.
function actionKey(step) {
  const { p_world, yaw_rad, pitch_rad } = step.agent;
  return JSON.stringify([step.goal, step.action,
    ...[...p_world, yaw_rad, pitch_rad].map((v) => Math.round(v * 1e4))]);
}

/// Equal for steps with the same decision.
function decisionKey(step) {
  const target = step.candidates.find((candidate) => candidate.is_target);
  return JSON.stringify([step.goal, step.mode, step.activity, step.reason, target?.kind, target?.p_world]);
}

/// First indices at which two runs differ in decision and in action; the end of the shorter run is
/// a difference. -1: none.
export function partingOf(a, b) {
  const common = Math.min(a.steps.length, b.steps.length);
  const first = (key) => {
    for (let i = 0; i < common; ++i) if (key(a.steps[i]) !== key(b.steps[i])) return i;
    return a.steps.length === b.steps.length ? -1 : common;
  };
  return { decision: first(decisionKey), action: first(actionKey) };
}

/// "full", or "full 12ab34cd" if the variants are equal.
export function runNames(runs) {
  const [a, b] = runs.map(({ info }) => info.variant || "run");
  if (a !== b) return [a, b];
  return runs.map(({ info }) => `${a} ${(info.config_hash || "").slice(0, 8)}`.trim());
}

export class CompareBar {
  constructor(app) {
    this.app = app;
    this.parting = partingOf(...app.runs);
    this.names = runNames(app.runs).map((name, i) => `${"AB"[i]} ${name}`);
    byId("compare").hidden = false;
    this.buttons = [0, 1].map((run) => {
      const button = byId(`run-${run}`);
      button.textContent = this.names[run];
      button.addEventListener("click", () => app.switchTo(run));
      return button;
    });
    byId("to-parting").addEventListener("click", () => this.showParting());
    const { decision, action } = this.parting;
    const at = (index) => `step ${(app.runs[0].steps[index] ?? app.runs[1].steps[index]).step}`;
    byId("to-parting").hidden = action < 0 && decision < 0;
    byId("parting").textContent = action < 0 && decision < 0 ? "They are the same to the end."
      : `They decide differently from ${decision < 0 ? "no step" : at(decision)} and act ` +
        `differently from ${action < 0 ? "no step" : at(action)}.`;
  }

  /// Step at which the page opens; the runs may be equal to the end.
  opening() {
    const { decision, action } = this.parting;
    return { index: Math.max(0, decision < 0 ? action : decision), text: "" };
  }

  showParting() {
    this.app.seek(this.opening().index);
  }

  show(index) {
    this.buttons.forEach((button, run) => button.classList.toggle("on", run === this.app.run));
    const other = this.app.runs[1 - this.app.run], name = this.names[1 - this.app.run];
    const step = other.steps[index];
    if (!step) {
      byId("other-now").textContent = `${name} has ended.`;
      return;
    }
    const now = this.app.replay.steps[index];
    const isSame = actionKey(step) === actionKey(now) && decisionKey(step) === decisionKey(now);
    const what = [step.goal, step.activity || step.mode, step.action].filter(Boolean).map(words).join(", ");
    byId("other-now").textContent = isSame ? `${name} does the same here.`
      : `${name} here: ${what}${step.reason ? ` (${step.reason})` : ""}.`;
  }
}
