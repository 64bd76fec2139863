// Film strips: frames whose true picture is the same, and what changes between them.
import { choice, h } from "./dom.js";
import { layerTitle, measures, percent, shown } from "./format.js";
import { layers, pictures, report, seriesColour } from "./report.js";
import { colourBar, png } from "./viewer.js";

const strips = pictures.strips ?? {};
const stripOf = (method, cell) => strips[method.runs[0].id]?.[cell];

function picture(data, title, label) {
    return h(
        "figure",
        {},
        h("img", { src: png(data), alt: `${title}: ${label}` }),
        h("figcaption", { class: "muted" }, label),
    );
}

function row(method, index, cell) {
    const strip = stripOf(method, cell);
    if (!strip) return null;
    const run = method.runs[0];
    const error = run.errors[cell]?.[report.measure];
    return h(
        "div",
        { class: "strip", dataset: { run: run.id } },
        h(
            "div",
            { class: "strip-head" },
            h("i", { class: "swatch", style: { background: seriesColour(index) } }),
            " ",
            h("strong", {}, method.label),
            h("span", {}, ` flicker ${percent(method.flicker[cell])}`),
            h("span", { class: "muted" }, `error ${shown(report.measure, error)} \u00b7 ${run.label}`),
        ),
        h(
            "div",
            { class: "film" },
            strip.frames.map((frame, i) => picture(frame, method.label, `frame ${i + 1}`)),
            picture(strip.change, method.label, "change"),
        ),
    );
}

const help =
    "Frames of the cheapest run of each method, whose true picture is the same: from one to the next everything, with " +
    "the camera, is moved by 3, 5 and 7 voxels, and all seeds are others, as if the explosion had changed. " +
    "Whatever differs between them is flicker: the root mean square of the change from frame to frame, over the root " +
    "of 2, relative to the reference. Noise that is new in each frame has as much flicker as error; bias that stands " +
    "still has none. ";

export function addStrips(section, link) {
    const cells = layers.filter((cell) => report.methods.some((method) => stripOf(method, cell)));
    if (cells.length === 0) return;
    section.hidden = link.hidden = false;
    // That in which most methods compete.
    const competing = (cell) => report.methods.filter((method) => stripOf(method, cell)).length;
    const first = cells.reduce((best, cell) => (competing(cell) > competing(best) ? cell : best));
    const holder = h("div", { class: "strips" }),
        exposure = h("p", { class: "muted" });
    const show = (cell) => {
        holder.replaceChildren(...report.methods.map((method, i) => row(method, i, cell)).filter((r) => r !== null));
        const stops = report.methods.map((method) => stripOf(method, cell)).find((strip) => strip).exposure;
        exposure.textContent =
            `Errors are ${measures[report.measure].title}. ` +
            `Pictures of ${layerTitle(cell)} at ${stops.toFixed(2)} stops, which its reference asks for.`;
    };
    const options = cells.map((value) => ({ value, label: layerTitle(value) }));
    section.append(
        h("p", { class: "muted" }, help),
        h("div", { class: "controls" }, choice("Cell", options, first, show).element),
        exposure,
        holder,
        colourBar("relative", "change from frame to frame, relative to the reference, logarithmic"),
    );
    show(first);
}
