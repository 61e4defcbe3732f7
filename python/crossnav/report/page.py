# SPDX-License-Identifier: MIT
"""The page: one HTML file that needs no network."""

import base64
import html
import math
from typing import Any

import pandas as pd

from crossnav import _core
from crossnav.report.data import Report
from crossnav.report.plots import Plot

STYLE = """
:root { --ink: #1a1a1a; --soft: #5a5a5a; --line: #d5d5d5; --back: #fff; --card: #f6f6f4; }
* { box-sizing: border-box; }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--back);
       margin: 0 auto; padding: 24px; max-width: 1240px; }
h1 { font-size: 26px; margin: 0 0 4px; } h2 { font-size: 19px; margin: 36px 0 4px; }
p, figcaption { color: var(--soft); margin: 0 0 12px; } figure { margin: 0; }
nav { margin: 12px 0 0; } nav a { margin-right: 14px; white-space: nowrap; }
a { color: #20476b; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(290px, 1fr)); gap: 16px;
         margin-top: 20px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 6px;
        padding: 14px 16px; }
.card h3 { margin: 0 0 2px; font-size: 16px; overflow-wrap: anywhere; }
.big { display: flex; flex-wrap: wrap; gap: 8px 22px; margin: 8px 0; }
.big b { display: block; font-size: 24px; white-space: nowrap; }
.big span { color: var(--soft); font-size: 12px; }
.card small { color: var(--soft); display: block; overflow-wrap: anywhere; }
img { max-width: 100%; height: auto; display: block; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 13px; }
th, td { padding: 4px 8px; text-align: left; border-bottom: 1px solid var(--line);
         vertical-align: top; }
td.n, th.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
th button { font: inherit; font-weight: 600; border: 0; background: none; padding: 0;
            cursor: pointer; color: inherit; }
th[aria-sort=ascending] button::after { content: " \\25B2"; }
th[aria-sort=descending] button::after { content: " \\25BC"; }
table.narrow { width: auto; margin-bottom: 12px; }
@media (max-width: 900px) { table { font-size: 12px; } th, td { padding: 3px 4px; } }
 h3 { font-size: 16px; margin: 18px 0 2px; }
input { font: inherit; padding: 4px 8px; margin-bottom: 8px; width: min(100%, 340px); }
@media print { nav, input { display: none; } body { max-width: none; } }
"""

SCRIPT = """
const table = document.querySelector("#episode-table"), body = table.tBodies[0];
table.querySelectorAll("th").forEach((head, column) => {
  head.querySelector("button").addEventListener("click", () => {
    const up = head.getAttribute("aria-sort") !== "ascending";
    table.querySelectorAll("th").forEach(h => h.removeAttribute("aria-sort"));
    head.setAttribute("aria-sort", up ? "ascending" : "descending");
    const key = row => row.cells[column].dataset.v ?? row.cells[column].textContent;
    const number = head.classList.contains("n");
    [...body.rows].sort((a, b) => (up ? 1 : -1) * (number ? key(a) - key(b)
      : key(a).localeCompare(key(b)))).forEach(row => body.append(row));
  });
});
const filter = document.querySelector("#filter"), shown = document.querySelector("#shown");
filter.addEventListener("input", () => {
  const words = filter.value.toLowerCase().split(/\\s+/).filter(Boolean);
  let n = 0;
  for (const row of body.rows) {
    const text = row.textContent.toLowerCase();
    row.hidden = !words.every(word => text.includes(word));
    n += row.hidden ? 0 : 1;
  }
  shown.textContent = n;
});
"""

COLUMNS = (("run", "run", ""), ("episode", "episode", ""), ("replay", "replay", ""),
           ("floor_change", "floor change", ""),
           ("goals", "goals", ""), ("outcome", "outcome", ""), ("completed", "goals found", "d"),
           ("spl", "SPL [%]", "%"), ("actions", "actions", "d"), ("length_m", "path [m]", ".1f"),
           ("floor_changes", "floors changed", "d"), ("cause", "cause", ""))


def _text(value: Any) -> str:
    return html.escape(str(value), quote=True)


def _per_cent(row: dict[str, Any]) -> str:
    if math.isnan(row["value"]):
        return "-"
    text = f"{100 * row['value']:.1f}"
    if not math.isnan(row["low"]):
        text += f" [{100 * row['low']:.1f}, {100 * row['high']:.1f}]"
    return text


def _tracks(report: Report, run: str) -> list[str]:
    """Tracks of a run with several; a run of one track has it in its name."""
    groups = report.figures[report.figures.run == run].group.unique()
    tracks = [group for group in groups if group.startswith("track:") and group.count(":") == 1]
    return tracks if len(tracks) > 1 else []


def _track_card(report: Report, run: dict[str, Any], tracks: list[str]) -> str:
    """A card that pools nothing."""
    big = ""
    for track in tracks:
        for label, group, metric in (("SR", track, "SR"), ("SPL", track, "SPL"),
                                     ("SR, floor change", track + ":cfr", "SR")):
            row = report.figure(run["name"], group, metric)
            value = "-" if math.isnan(row["value"]) else f"{100 * row['value']:.1f} %"
            big += (f"<span>{_text(track[len('track:'):])}: {label}<b>{value}</b>"
                    f"n = {row['episodes']}</span>")
    return (f'<div class="card"><h3>{_text(run["name"])}</h3><div class="big">{big}</div>'
            f"<small>variant {_text(run['variant'] or 'unknown')}; plots and figures of this run "
            f"pool its tracks</small></div>")


def _card(report: Report, run: dict[str, Any]) -> str:
    name = run["name"]
    if tracks := _tracks(report, name):
        return _track_card(report, run, tracks)
    big = ""
    for label, group, metric in (("SR", "all", "SR"), ("SPL", "all", "SPL"),
                                 ("SR, floor change", "cfr", "SR")):
        row = report.figure(name, group, metric)
        value = "-" if math.isnan(row["value"]) else f"{100 * row['value']:.1f} %"
        interval = "" if math.isnan(row["low"]) else (
            f"{100 * row['low']:.0f} to {100 * row['high']:.0f}, ")
        big += f"<span>{label}<b>{value}</b>{interval}n = {row['episodes']}</span>"
    failed = run.get("failed") or {}
    notes = [f"variant {run['variant'] or 'unknown'}", run["perception"] or "perception unknown",
             f"settings {run['config_hash'] or '-'}", f"episodes {run['episodes_hash'] or '-'}"]
    notes += [f"{count} without a result ({reason})" for reason, count in failed.items()]
    return (f'<div class="card"><h3>{_text(name)}</h3><div class="big">{big}</div>'
            f"<small>{_text(' · '.join(notes))}</small></div>")


def _figure_table(report: Report) -> str:
    """Every figure of all episodes and of the floor groups, beside the paper's."""
    groups = [("all", "all"), ("same_floor", "no floor change"), ("cfr", "floor change")]
    metrics = ["SR", "SPL", "PR", "PPL"]
    for k in range(1, report.goals + 1):
        metrics += [f"{m}_{kind}_{k}" for kind in ("cond", "global") for m in ("SR", "SPL")]
    has_paper = {group: report.figures[report.figures.group == group].paper.notna().any()
                 for group, _ in groups}
    head = "".join(f'<th class="n">{_text(label)}</th>'
                   + '<th class="n">the paper</th>' * bool(has_paper[group])
                   for group, label in groups)
    rows = ""
    for run in report.runs:
        for metric in metrics:
            cells = ""
            for group, _ in groups:
                row = report.figure(run["name"], group, metric)
                cells += f'<td class="n">{_per_cent(row)}</td>'
                paper = "" if math.isnan(row["paper"]) else f"{100 * row['paper']:.1f}"
                cells += f'<td class="n">{paper}</td>' * bool(has_paper[group])
            pooled = " (tracks pooled)" if _tracks(report, run["name"]) else ""
            rows += f"<tr><td>{_text(run['name'] + pooled)}</td><td>{metric}</td>{cells}</tr>"
    return (f'<div class="scroll"><table><thead><tr><th>run</th><th>figure [%]</th>{head}</tr>'
            f"</thead><tbody>{rows}</tbody></table></div>")


def _difference_text(row: dict[str, Any]) -> str:
    unit = 1 if row["metric"] == "distance_to_goal_m" else 100
    return "{:+.1f} [{:+.1f}, {:+.1f}]".format(*(unit * row[k] for k in ("difference", "low",
                                                                        "high")))


def _comparison(report: Report, before: str, after: str) -> str:
    """One run against the first: differences of the sequence figures, and episodes that flipped."""
    of = report.differences
    rows = of[(of.before == before) & (of.after == after)].to_dict("records")
    shown = "".join(f'<tr><td>{row["metric"]}</td><td class="n">{_difference_text(row)}</td></tr>'
                    for row in rows if row["metric"] in ("SR", "SPL", "PR", "PPL"))
    flips = report.flips[(report.flips.before == before) & (report.flips.after == after)]
    lines = "".join(
        f"<tr><td>{_text(flip['episode'])}</td><td>{flip['outcome_before']} "
        f"({flip['goals_before']}/{flip['goals']})</td><td>{flip['outcome_after']} "
        f"({flip['goals_after']}/{flip['goals']})</td><td>{_text(flip['cause'])}</td>"
        f"{_cell('replay', '', flip['replay'])}</tr>" for flip in flips.to_dict("records"))
    table = (f'<div class="scroll"><table><thead><tr><th>episode</th><th>{_text(before)}</th>'
             f"<th>{_text(after)}</th><th>cause</th><th>replay</th></tr></thead><tbody>{lines}"
             f"</tbody></table></div>") if lines else ""
    return (f"<h3>{_text(after)} against {_text(before)}</h3>"
            f"<p>Of the {rows[0]['episodes']} episodes that both have, {len(flips)} were completed "
            f"in one of the two only. Differences in points of per cent, 95 % by bootstrap over "
            f"{'scenes' if rows[0]['scenes'] > 1 else 'episodes'}.</p>"
            f'<div class="scroll"><table class="narrow"><thead><tr><th>figure</th>'
            f'<th class="n">difference</th></tr></thead><tbody>{shown}</tbody></table></div>{table}')


def _comparisons(report: Report) -> str:
    pairs = report.differences[["before", "after"]].drop_duplicates().itertuples(index=False)
    text = "".join(_comparison(report, *pair) for pair in pairs)
    if not text:
        return ""
    notes = "".join(f"<li>{_text(note)}</li>" for note in report.notes)
    return (f'<section id="compared"><h2>Compared, episode by episode</h2><ul>{notes}</ul>{text}'
            f"</section>")


def _cell(column: str, kind: str, value: Any) -> str:
    if column == "replay":
        link = f'<a href="{_text(value)}">replay</a>' if value else "-"
        return f"<td>{link}</td>"
    if not kind:
        return f"<td>{_text(value)}</td>"
    text = f"{100 * value:.1f}" if kind == "%" else format(value, kind)
    return f'<td class="n" data-v="{value}">{text}</td>'


def _episode_table(report: Report) -> str:
    head = "".join(f'<th class="{"n" if kind else ""}" scope="col"><button>{label}</button></th>'
                   for _, label, kind in COLUMNS)
    rows = "".join(
        "<tr>" + "".join(_cell(column, kind, row[column]) for column, _, kind in COLUMNS) + "</tr>"
        for row in report.episodes.to_dict("records"))
    return (f'<input id="filter" type="search" aria-label="filter episodes" '
            f'placeholder="filter, e.g. required out_of_time">'
            f'<p><span id="shown">{len(report.episodes)}</span> of {len(report.episodes)} '
            f"episodes; a click on a heading sorts.</p>"
            f'<div class="scroll"><table id="episode-table"><thead><tr>{head}</tr></thead>'
            f"<tbody>{rows}</tbody></table></div>")


def _download(name: str, table: pd.DataFrame) -> str:
    links = ""
    for kind, mime, text in (("CSV", "text/csv", table.to_csv(index=False)),
                             ("JSON", "application/json", table.to_json(orient="records"))):
        data = base64.b64encode(text.encode()).decode()
        links += (f' <a download="{name}.{kind.lower()}" '
                  f'href="data:{mime};base64,{data}">{kind}</a>')
    return f"<li>{name} ({len(table)} rows):{links}</li>"


def page(report: Report, plots: list[Plot]) -> str:
    """The whole page; links to replays are relative to it."""
    names = ", ".join(run["name"] for run in report.runs)
    sections, links = "", ""
    for plot in plots:
        data = base64.b64encode(plot.svg.encode()).decode()
        sections += (f'<section id="{plot.name}"><h2>{_text(plot.title)}</h2><figure>'
                     f"<figcaption>{_text(plot.note)}</figcaption>"
                     f'<img alt="{_text(plot.title)}" src="data:image/svg+xml;base64,{data}">'
                     f"</figure></section>")
        links += f'<a href="#{plot.name}">{_text(plot.title)}</a> '
    compared = _comparisons(report)
    links += '<a href="#compared">Compared</a> ' if compared else ""
    cards = "".join(_card(report, run) for run in report.runs)
    downloads = "".join(_download(name, table) for name, table in report.tables().items())
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>crossnav report: {_text(names)}</title><style>{STYLE}</style></head><body>"
            f"<h1>crossnav report</h1><p>{_text(names)}; crossnav {_core.VERSION}. Intervals are "
            f"bootstrap 95 %; the paper's values are printed beside, for other scenes and other "
            f"perception.</p><nav>{links}<a href=\"#figures\">Figures</a> "
            f'<a href="#episodes">Episodes</a></nav><div class="cards">{cards}</div>{sections}'
            f'{compared}<section id="figures"><h2>Figures</h2>{_figure_table(report)}</section>'
            f'<section id="episodes"><h2>Episodes</h2>{_episode_table(report)}</section>'
            f"<section><h2>Tables</h2><ul>{downloads}</ul></section>"
            f"<script>{SCRIPT}</script></body></html>\n")
