// Any two pictures behind a slider.
import "img-comparison-slider";
import { choice, h } from "./dom.js";
import { layerTitle, measures, seconds, withBar } from "./format.js";
import { findRun, layers, nameOf, picturedRuns, pictures, reference, report, spreadOf } from "./report.js";

export const png = (base64) => `data:image/png;base64,${base64}`;
const stops = (value) => `${value < 0 ? "\u2212" : "+"}${Math.abs(value)} EV`.replace("+0 EV", "0 EV");

// What a picture can show. A map exists for runs only: the reference has no error.
const kinds = {
    picture: { label: "Picture" },
    relative: { label: "Relative error", title: "|I-R| / (|R| + \u03b5) of each pixel" },
    flip: { label: "HDR-FLIP", title: "Perceived difference of each pixel, 0 to 1" },
    difference: { label: "Left \u2212 right", title: "Difference of the two as shown, four times amplified" },
};

function source(id, { layer, kind, exposure }) {
    if (kind === "relative") return pictures.relative[id]?.[layer];
    if (kind === "flip") return pictures.flip[id]?.[layer];
    return pictures.images[id]?.[layer]?.[exposure];
}

const blank = "data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAAAAAAALAAAAAABAAEAAAIBAAA7";

export function setPicture(image, id, state) {
    const data = source(id, state);
    image.src = data ? png(data) : blank;
    image.alt = `${nameOf(id)}, ${layerTitle(state.layer)}, ${kinds[state.kind].label}`;
    image.title = data
        ? ""
        : id === reference && state.kind !== "picture"
          ? "The reference has no error"
          : "No picture of this layer";
}

export function caption(id, layer) {
    const found = findRun(id);
    if (!found) return "what the others are measured against";
    const error = found.run.errors[layer]?.[report.measure];
    return `${withBar(report.measure, error, spreadOf(found.run, layer, report.measure))} \u00b7 ${seconds(found.run.wall_seconds)}`;
}

function pictureSelect(label, onchange) {
    const groups = report.methods.map((method) =>
        h(
            "optgroup",
            { label: method.label },
            picturedRuns(method).map((run) => h("option", { value: run.id }, nameOf(run.id))),
        ),
    );
    return h("select", { "aria-label": label, onchange }, h("option", { value: reference }, "Reference"), groups);
}

const ticks = {
    relative: { low: "0.1 %", middle: ["1 %", "10 %"], high: "100 %", text: "relative error, logarithmic" },
    flip: { low: "0", middle: ["0.5"], high: "1", text: "HDR-FLIP error" },
};

export function colourBar(kind, what) {
    const { low, middle, high, text } = ticks[kind];
    const gradient = `linear-gradient(to right, ${pictures.palette.join(",")})`;
    return h(
        "div",
        { class: "colour-bar" },
        h("span", { class: "muted" }, what ?? text),
        h(
            "div",
            {},
            h("div", { class: "ramp", style: { background: gradient } }),
            h(
                "div",
                { class: "ticks" },
                [low, ...middle, high].map((tick) => h("span", {}, tick)),
            ),
        ),
    );
}

export class Viewer {
    constructor() {
        const last = (method) => picturedRuns(method).at(-1).id;
        const [first, second] = report.methods.filter((method) => picturedRuns(method).length > 0);
        this.state = {
            left: first ? last(first) : reference,
            right: second ? last(second) : reference,
            layer: "",
            kind: "picture",
            exposure: Math.floor(pictures.exposures.length / 2),
            zoom: "fit",
        };
        this.listeners = [];
        this.first = h("img", { slot: "first" });
        this.second = h("img", { slot: "second" });
        this.slider = h("img-comparison-slider", { id: "slider", value: "50", tabindex: "0" }, this.first, this.second);
        ((this.under = h("img")), (this.over = h("img", { class: "over" })));
        this.blend = h("div", { class: "blend" }, this.under, this.over);
        this.stage = h("div", { class: "stage" }, this.slider, this.blend);
        this.selects = {
            left: pictureSelect("Left picture", (e) => this.show({ left: e.target.value })),
            right: pictureSelect("Right picture", (e) => this.show({ right: e.target.value })),
        };
        this.captions = { left: h("span", { class: "muted" }), right: h("span", { class: "muted" }) };
        this.bar = h("div");
        this.element = h("div", { class: "viewer" }, this.controls(), this.sides(), this.stage, this.bar);
        new ResizeObserver(() => this.resize()).observe(this.stage);
        document.addEventListener("keydown", (event) => this.key(event));
    }

    onChange(listener) {
        this.listeners.push(listener);
    }

    controls() {
        const control = (label, key, options) => {
            const made = choice(label, options, this.state[key], (value) => this.show({ [key]: value }));
            return made.element;
        };
        const maps = Object.entries(kinds).map(([value, { label, title }]) => ({ value, label, title }));
        return h(
            "div",
            { class: "controls" },
            control("Show", "kind", maps),
            control(
                "Layer",
                "layer",
                layers.map((value) => ({ value, label: layerTitle(value) })),
            ),
            control(
                "Exposure",
                "exposure",
                pictures.exposures.map((value, i) => ({
                    value: i,
                    label: stops(value),
                    title: `${(pictures.base_exposure + value).toFixed(2)} stops`,
                })),
            ),
            control(
                "Zoom",
                "zoom",
                ["fit", 1, 2, 4].map((value) => ({ value, label: value === "fit" ? "Fit" : `${value}\u00d7` })),
            ),
        );
    }

    sides() {
        const swap = h(
            "button",
            { type: "button", title: "Swap left and right (key: x)", onclick: () => this.swap() },
            "\u21c4",
        );
        const near = (text, key) =>
            h(
                "button",
                {
                    type: "button",
                    class: "plain",
                    title: `The right-hand method's run nearest in ${text} to the left picture`,
                    onclick: () => this.match(key),
                },
                `match ${text}`,
            );
        return h(
            "div",
            { class: "sides" },
            h("div", {}, h("label", {}, "Left ", this.selects.left), this.captions.left),
            swap,
            h(
                "div",
                {},
                h("label", {}, "Right ", this.selects.right),
                this.captions.right,
                h(
                    "span",
                    {},
                    near("time", (run) => run.wall_seconds),
                    " ",
                    near("error", (run) => run.errors[this.state.layer]?.[report.measure]),
                ),
            ),
        );
    }

    swap() {
        this.show({ left: this.state.right, right: this.state.left });
    }

    // Equal time or equal error, as nearly as there are runs of it.
    match(key) {
        const left = findRun(this.state.left),
            right = findRun(this.state.right);
        const wanted = left && key(left.run);
        if (!right || !(wanted > 0)) return;
        const distance = (run) => (key(run) > 0 ? Math.abs(Math.log(key(run) / wanted)) : Infinity);
        const best = picturedRuns(right.method).reduce((a, b) => (distance(b) < distance(a) ? b : a));
        this.show({ right: best.id });
    }

    // f holds the right picture in place of the left one: differences jump to the eye. x swaps.
    key(event) {
        if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName))
            return;
        if (event.key === "x") this.swap();
        if (event.key === "f") this.slider.value = this.slider.value > 50 ? 0 : 100;
    }

    show(change) {
        Object.assign(this.state, change);
        const { left, right, kind } = this.state;
        this.selects.left.value = left;
        this.selects.right.value = right;
        this.captions.left.textContent = caption(left, this.state.layer);
        this.captions.right.textContent = caption(right, this.state.layer);
        const difference = kind === "difference";
        this.slider.hidden = difference;
        this.blend.hidden = !difference;
        setPicture(difference ? this.under : this.first, left, this.state);
        setPicture(difference ? this.over : this.second, right, this.state);
        this.bar.replaceChildren(...(ticks[kind] ? [colourBar(kind)] : []));
        this.resize();
        this.listeners.forEach((listener) => listener(this.state));
    }

    // Whole multiples of a pixel wherever they fit: what is seen is then what was computed.
    resize() {
        const room = this.stage.clientWidth;
        if (room === 0) return;
        const { width, height } = pictures;
        const fit = room >= width ? Math.floor(room / width) : room / width;
        const zoom = this.state.zoom === "fit" ? fit : this.state.zoom;
        for (const image of [this.first, this.second, this.under, this.over]) {
            image.style.width = `${width * zoom}px`;
            image.style.height = `${height * zoom}px`;
        }
        this.stage.classList.toggle("larger", width * zoom > room);
    }
}
