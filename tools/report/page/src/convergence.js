// Error against time: the plot, and the tables that read numbers off it.
import { choice, h, table } from "./dom.js";
import { clocks, known, layerTitle, measures, number, percent, seconds, times } from "./format.js";
import { ErrorPlot } from "./plot.js";
import { aboutBars, lawOf, layers, report, seriesColour, takenMeasures } from "./report.js";

const swatch = (index) => h("i", { class: "swatch", style: { background: seriesColour(index) } });

const methodHead = (method, index) => h("th", { scope: "row" }, swatch(index), " ", method.label);

// Seconds of one TimeToError, said so that nobody takes an extrapolation for a measurement.
function timeCell(entry) {
    if (entry.kind === "not_reached")
        return h("td", { class: "not-reached" }, "not reached", h("small", {}, `bias floor ${percent(entry.floor)}`));
    const said = { interpolated: "", extrapolated: "extrapolated", at_most: "or less" }[entry.kind];
    return h("td", { class: entry.kind }, seconds(entry.seconds), said ? h("small", {}, said) : null);
}

const ratioOf = (entry, base) =>
    entry.kind !== "not_reached" && base && base.kind !== "not_reached" ? entry.seconds / base.seconds : NaN;

function ratioCell(entry, base) {
    const certain = [entry, base].every((e) => e && e.kind === "interpolated");
    return h("td", { class: `ratio ${certain ? "" : "extrapolated"}` }, times(ratioOf(entry, base)));
}

// Of a method that averages also the slope against the number of paths: -1/2 unless something is wrong.
function slopeCell(law) {
    const inPaths = known(law?.slope_in_paths) ? h("small", {}, `${number(law.slope_in_paths, 2)} in paths`) : null;
    return h("td", {}, known(law?.slope) ? number(law.slope, 2) : "\u2013", inPaths);
}

function reachTable(state, base) {
    const laws = report.methods.map((method) => lawOf(method, state.layer, state.clock));
    const head = [h("th", { scope: "col" }, "Method"), h("th", { scope: "col", class: "numbers" }, "Slope")];
    for (const target of report.targets)
        head.push(h("th", { scope: "col", class: "numbers" }, percent(target)), h("th", { class: "ratio" }, "ratio"));
    const rows = report.methods.map((method, i) => {
        const cells = [methodHead(method, i), slopeCell(laws[i])];
        report.targets.forEach((_, t) => {
            const entry = laws[i]?.times[t];
            if (!entry) return cells.push(h("td", {}, "\u2013"), h("td", { class: "ratio" }));
            cells.push(timeCell(entry), ratioCell(entry, laws[base]?.times[t]));
        });
        return h("tr", {}, cells);
    });
    return table(head, rows, { id: "reach-table", class: "reach" });
}

function errorCell(entry) {
    if (!entry || entry.kind === "not_reached") return h("td", { class: "muted" }, "\u2013");
    const said = { interpolated: "", extrapolated: "extrapolated", at_most: "finished" }[entry.kind];
    return h("td", { class: entry.kind }, percent(entry.error), said ? h("small", {}, said) : null);
}

function equalTimeTable(state) {
    const clockTimes = report.equal_times[state.clock];
    const head = [
        h("th", { scope: "col" }, "Method"),
        clockTimes.map((t) => h("th", { scope: "col", class: "numbers" }, seconds(t))),
    ];
    const rows = report.methods.map((method, i) => {
        const law = lawOf(method, state.layer, state.clock);
        return h(
            "tr",
            {},
            methodHead(method, i),
            clockTimes.map((_, t) => errorCell(law?.errors[t])),
        );
    });
    return table(head.flat(), rows, { id: "equal-time-table" });
}

function aboutNoise() {
    const noise = report.reference.noise[""];
    if (!known(noise))
        return "The reference is one picture: its own noise is not known, and is part of every error here.";
    const stated = `The reference's own noise is ${percent(noise)} rRMSE (beauty).`;
    return report.measure === "noise_free"
        ? `${stated} Errors are judged by its two independent halves, which leaves that noise out.`
        : `${stated} Errors below twice that are marked: they measure the reference.`;
}

// By which settings the steps of each method differ.
function aboutSteps() {
    const keysOf = (method) => [
        ...new Set(method.runs.flatMap((run) => run.settings.map((text) => text.split("=")[0]))),
    ];
    const texts = report.methods.map((method) => `${method.label} by ${keysOf(method).join(", ") || "nothing"}`);
    return `Steps: ${texts.join("; ")}. spp: paths per pixel.`;
}

function disturbed() {
    const { machine, time } = report;
    return (
        `Only ${number(time.processors_busy, 2)} of ${machine.threads} processors were busy with rendering, in the ` +
        "mean: other work disturbed the wall times, or parts of the methods are serial. CPU times are the safer ones " +
        "to compare."
    );
}

const reachHelp =
    "Read off the straight lines between measured points, both axes logarithmic. Beyond the last point an unbiased " +
    "method is extrapolated from its longest run by the law of averages: after the start-up, the time that fewer " +
    "paths do not shorten, its error falls as time to the power of \u2212\u00bd. A " +
    "biased one stays at its lowest measured error, its bias floor. \u201cOr less\u201d: the cheapest run was already " +
    "better, or the error had become too small to be distinguished from 0. Slope: least squares through all points, " +
    "against time and against the number of paths.";

export function addConvergence(plotSection, reachSection, equalTimeSection) {
    const state = { layer: "", measure: takenMeasures[0], clock: "wall" };
    const plot = new ErrorPlot();
    const baseSelect = h(
        "select",
        { "aria-label": "Ratios relative to", onchange: () => update() },
        report.methods.map((method, i) => h("option", { value: i, selected: i === report.baseline }, method.label)),
    );
    const reach = h("div"),
        equalTime = h("div"),
        help = h("p", { class: "muted" });
    const titles = [reachSection, equalTimeSection].map(() => h("p", { class: "muted" }));

    function update() {
        plot.draw(state);
        help.textContent = `${measures[state.measure].title}: ${measures[state.measure].help}.`;
        reach.replaceChildren(reachTable(state, Number(baseSelect.value)));
        equalTime.replaceChildren(equalTimeTable(state));
        const which = `${layerTitle(state.layer)}, ${measures[report.measure].title}, ${clocks[state.clock].text}.`;
        titles.forEach((title) => (title.textContent = which));
    }
    const control = (label, key, options) =>
        choice(label, options, state[key], (value) => {
            state[key] = value;
            update();
        }).element;

    plotSection.append(
        h("p", {}, aboutNoise()),
        report.time.disturbed ? h("p", { class: "note" }, disturbed()) : "",
        h(
            "div",
            { class: "controls" },
            control(
                "Layer",
                "layer",
                layers.map((value) => ({ value, label: layerTitle(value) })),
            ),
            control(
                "Measure",
                "measure",
                takenMeasures.map((value) => ({ value, label: measures[value].title })),
            ),
            control(
                "Time",
                "clock",
                Object.entries(clocks).map(([value, { title }]) => ({ value, label: title })),
            ),
        ),
        plot.element,
        help,
        aboutBars ? h("p", { class: "muted" }, aboutBars) : "",
        h(
            "p",
            { class: "muted" },
            "Dotted: what more time would give. Click a point to see its picture; click a name to hide its line. ",
            aboutSteps(),
        ),
    );
    reachSection.append(
        titles[0],
        reach,
        h("p", { class: "controls" }, h("label", {}, "Ratios relative to ", baseSelect)),
        h("p", { class: "muted" }, reachHelp),
    );
    equalTimeSection.append(
        titles[1],
        equalTime,
        h(
            "p",
            { class: "muted" },
            "\u201cFinished\u201d: the method had ended by then, and more time would not help it.",
        ),
    );
    update();
    return plot;
}
