// Every number of every run, per ledger cell.
import { choice, h, table } from "./dom.js";
import { known, layerTitle, measures, number, percent, seconds, withBar } from "./format.js";
import { aboutBars, layers, report, seriesColour, spreadOf, takenMeasures } from "./report.js";

function signed(share, deviation) {
    if (!known(share)) return "\u2013";
    const text = known(deviation) ? withBar("rrmse", share, deviation) : percent(share);
    return share > 0 ? `+${text}` : text;
}

function row(method, index, run, layer) {
    const errors = run.errors[layer];
    const bad = errors ? errors.not_finite.image + errors.not_finite.reference : 0;
    const marks = [];
    if (errors?.below_noise)
        marks.push(h("small", { class: "flag", title: "rRMSE below twice the reference's noise" }, "reference noise"));
    if (bad > 0) marks.push(h("small", { class: "flag" }, `${bad} pixels not finite`));
    return h(
        "tr",
        {},
        h(
            "th",
            { scope: "row" },
            h("i", { class: "swatch", style: { background: seriesColour(index) } }),
            " ",
            method.label,
        ),
        h("td", { title: run.settings.join(" ") }, run.label),
        h("td", { class: "numbers" }, number(run.samples_per_pixel)),
        h("td", { class: "numbers" }, seconds(run.wall_seconds)),
        h("td", { class: "numbers" }, seconds(run.cpu_seconds)),
        takenMeasures.map((measure) =>
            h(
                "td",
                { class: "numbers" },
                errors ? withBar(measure, errors[measure], spreadOf(run, layer, measure)) : "\u2013",
                measure === "rrmse" ? marks : [],
            ),
        ),
        h("td", { class: "numbers" }, errors ? signed(errors.mean, spreadOf(run, layer, "mean")) : "\u2013"),
    );
}

export function addMeasurements(section) {
    const holder = h("div");
    const head = [
        h("th", { scope: "col" }, "Method"),
        h("th", { scope: "col" }, "Setting"),
        h("th", { scope: "col", class: "numbers", title: "Camera rays, or paths, per pixel" }, "per pixel"),
        h("th", { scope: "col", class: "numbers" }, "Wall"),
        h("th", { scope: "col", class: "numbers" }, "CPU"),
        ...takenMeasures.map((measure) =>
            h("th", { scope: "col", class: "numbers", title: measures[measure].help }, measures[measure].title),
        ),
        h("th", { scope: "col", class: "numbers", title: "mean(I) / mean(R) - 1" }, "Bias"),
    ];
    const show = (layer) =>
        holder.replaceChildren(
            table(
                head.map((cell) => cell.cloneNode(true)),
                report.methods.flatMap((method, i) => method.runs.map((run) => row(method, i, run, layer))),
                { id: "measurements-table" },
            ),
        );
    const options = layers.map((value) => ({ value, label: layerTitle(value) }));
    section.append(
        h(
            "p",
            { class: "muted" },
            "The ledger's cells are V (fire seen directly), MV (its light scattered once) and MM " +
                "(scattered more than once); their sum is the beauty. Each is compared with the same cell of the reference.",
        ),
        aboutBars ? h("p", { class: "muted", id: "about-bars" }, aboutBars) : "",
        h("div", { class: "controls" }, choice("Layer", options, "", show).element),
        holder,
    );
    show("");
}
