// All that is needed to do it again: command lines, machine, the resolved shot.
import { codeBlock, h } from "./dom.js";
import { mebibytes, number, percent, seconds } from "./format.js";
import { report } from "./report.js";

function definitions(pairs) {
    return h(
        "dl",
        {},
        pairs
            .filter(([, value]) => value !== null && value !== undefined && value !== "")
            .flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, String(value))]),
    );
}

function machine() {
    const { machine: m } = report;
    return definitions([
        ["Processor", m.processor],
        ["Cores", `${m.cores}, ${m.logical} logical`],
        ["Threads used", m.threads],
        ["Memory", mebibytes(m.memory_bytes)],
        ["Load before", m.load.map((value) => number(value, 2)).join(", ")],
        ["System", m.system],
        ["Brisance", report.brisance],
        ["Date", report.date],
    ]);
}

function referencePart() {
    const { reference } = report;
    const noise = Object.entries(reference.noise)
        .filter(([, value]) => typeof value === "number")
        .map(([layer, value]) => `${layer || "beauty"} ${percent(value)}`)
        .join(", ");
    return h(
        "div",
        {},
        definitions([
            ["What", reference.description],
            ["Files", reference.files.join(", ")],
            ["Paths per pixel", reference.samples_per_pixel > 0 ? number(reference.samples_per_pixel, 6) : null],
            ["Wall time", reference.wall_seconds > 0 ? seconds(reference.wall_seconds) : null],
            ["CPU time", reference.cpu_seconds > 0 ? seconds(reference.cpu_seconds) : null],
            ["Its own noise", noise],
        ]),
        reference.notices.map((line) => h("p", { class: "note" }, line)),
        reference.command ? codeBlock(reference.command) : null,
    );
}

export function addRepeat(section) {
    section.append(
        h("h3", {}, "This report"),
        codeBlock(report.command),
        h("h3", {}, "Machine"),
        machine(),
        h("h3", {}, "Reference"),
        referencePart(),
    );
    for (const method of report.methods)
        section.append(
            h("h3", {}, method.label),
            ...method.runs.map((run) => h("div", {}, h("h4", {}, run.label), codeBlock(run.command))),
        );
    section.append(
        h(
            "details",
            {},
            h("summary", {}, "The resolved shot"),
            h("pre", { class: "json" }, JSON.stringify(report.shot.resolved, null, 2)),
        ),
    );
}
