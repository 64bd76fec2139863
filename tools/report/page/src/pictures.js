// The pictures: any two of them in the viewer, and all of them side by side.
import { h } from "./dom.js";
import { measures } from "./format.js";
import { picturedRuns, pictures, reference, report, seriesColour } from "./report.js";
import { caption, setPicture, Viewer } from "./viewer.js";

function thumbnail(viewer, id, title) {
    const image = h("img", { style: { "aspect-ratio": `${pictures.width} / ${pictures.height}` } });
    const figure = h(
        "figure",
        { dataset: { run: id } },
        h(
            "button",
            { type: "button", class: "thumb", title: "Show on the left", onclick: () => viewer.show({ left: id }) },
            image,
        ),
        h(
            "figcaption",
            {},
            h("strong", {}, title),
            h("span", { class: "muted caption" }),
            h(
                "span",
                {},
                h("button", { type: "button", class: "plain", onclick: () => viewer.show({ left: id }) }, "left"),
                " ",
                h("button", { type: "button", class: "plain", onclick: () => viewer.show({ right: id }) }, "right"),
            ),
        ),
    );
    viewer.onChange((state) => {
        // The difference of two is no picture of one.
        setPicture(image, id, state.kind === "difference" ? { ...state, kind: "picture" } : state);
        figure.querySelector(".caption").textContent = caption(id, state.layer);
        figure.classList.toggle("chosen", state.left === id || state.right === id);
    });
    return figure;
}

function gallery(viewer) {
    const rows = report.methods.map((method, index) =>
        h(
            "div",
            { class: "gallery-row" },
            h("h3", {}, h("i", { class: "swatch", style: { background: seriesColour(index) } }), " ", method.label),
            h(
                "div",
                { class: "thumbs" },
                picturedRuns(method).map((run) => thumbnail(viewer, run.id, run.label)),
            ),
        ),
    );
    return h(
        "div",
        { class: "gallery" },
        rows,
        h(
            "div",
            { class: "gallery-row" },
            h("h3", {}, "Reference"),
            h("div", { class: "thumbs" }, thumbnail(viewer, reference, report.reference.label)),
        ),
    );
}

function aboutPictures() {
    const reduced =
        pictures.width < report.shot.width
            ? ` They are reduced to ${pictures.width} \u00d7 ${pictures.height} pixels here: all errors are those of the full size.`
            : "";
    return (
        `Shown under the ${pictures.view} view transform; 0 EV is ${pictures.base_exposure.toFixed(2)} stops.${reduced} ` +
        "Drag the slider, or move it with the arrow keys; f flips between the two, x swaps them. " +
        `Beside each picture stand its error (${measures[report.measure].title}) and wall time.`
    );
}

export function addPictures(section) {
    const viewer = new Viewer();
    section.append(h("p", { class: "muted" }, aboutPictures()), viewer.element, gallery(viewer));
    viewer.show({});
    return viewer;
}
