// What each method ran and left out, and what each stage cost.
import { h, table } from "./dom.js";
import { mebibytes, number, percent, seconds } from "./format.js";
import { report, seriesColour } from "./report.js";

const unique = (values) => [...new Set(values)];

// Stages of all runs of a method by name, in the order in which they first ran.
const stageNames = (method) => unique(method.runs.flatMap((run) => run.statistics.stages.map((stage) => stage.name)));

function stageCell(run, name) {
    const stages = run.statistics.stages.filter((stage) => stage.name === name);
    if (stages.length === 0) return h("td", { class: "muted numbers" }, "\u2013");
    const time = stages.reduce((sum, stage) => sum + stage.seconds, 0);
    const bytes = stages.reduce((sum, stage) => sum + stage.bytes, 0);
    const share = run.wall_seconds > 0 ? Math.min(time / run.wall_seconds, 1) : 0;
    return h(
        "td",
        {
            class: "numbers stage-cost",
            title: `${percent(share, 2)} of the run`,
            style: { "--share": `${100 * share}%` },
        },
        seconds(time),
        h("small", {}, mebibytes(bytes)),
    );
}

function costTable(method) {
    const head = [
        h("th", { scope: "col" }, "Stage"),
        ...method.runs.map((run) => h("th", { scope: "col", class: "numbers" }, run.label)),
    ];
    const rows = stageNames(method).map((name) =>
        h(
            "tr",
            {},
            h("th", { scope: "row" }, name),
            method.runs.map((run) => stageCell(run, name)),
        ),
    );
    const total = (title, text) =>
        h(
            "tr",
            { class: "total" },
            h("th", { scope: "row" }, title),
            method.runs.map((run) => h("td", { class: "numbers" }, text(run))),
        );
    rows.push(
        total("Wall time", (run) => seconds(run.wall_seconds)),
        total("CPU time", (run) => seconds(run.cpu_seconds)),
        total("Processors busy", (run) => number(run.cpu_seconds / run.wall_seconds, 2)),
    );
    return table(head, rows);
}

function list(title, lines) {
    return lines.length === 0
        ? null
        : h(
              "div",
              {},
              h("h4", {}, title),
              h(
                  "ul",
                  {},
                  lines.map((line) => h("li", {}, line)),
              ),
          );
}

function plan(method) {
    const all = (pick) => unique(method.runs.flatMap((run) => pick(run.statistics)));
    const cells = all((statistics) => [statistics.cells.join(" + ") || "none: a black frame"]);
    return h(
        "div",
        {},
        h("p", {}, "Cells that ran: ", cells.join(", or ")),
        list(
            "Left out",
            all((s) => s.skipped.map(({ part, reason }) => `${part}: ${reason}`)),
        ),
        list(
            "Warnings",
            all((s) => s.warnings),
        ),
        list(
            "Notices",
            all((s) => s.notices),
        ),
    );
}

function details(method) {
    return h(
        "details",
        {},
        h("summary", {}, "Counts of every stage"),
        method.runs.map((run) =>
            h(
                "div",
                {},
                h("h4", {}, run.label),
                h("pre", { class: "json" }, JSON.stringify(run.statistics.stages, null, 2)),
            ),
        ),
    );
}

export function addCost(section) {
    section.append(h("p", { class: "muted" }, report.time.included, " ", report.time.excluded));
    report.methods.forEach((method, index) =>
        section.append(
            h("h3", {}, h("i", { class: "swatch", style: { background: seriesColour(index) } }), " ", method.label),
            costTable(method),
            plan(method),
            details(method),
        ),
    );
}
