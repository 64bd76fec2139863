// Of a page with several scenes: who is best where, what failed, and the choice of the scene that the page shows.
import { h, table } from "./dom.js";
import { percent, seconds } from "./format.js";
import { sceneIndex, suite } from "./report.js";

const marks = { extrapolated: "~ ", at_most: "\u2264 " };

function shownError(cell, index) {
    const { method, error } = cell.contenders[index];
    const doubtful = error.value < cell.reference_noise ? " \u2020" : "";
    return `${method} (${marks[error.kind] ?? ""}${percent(error.value)}${doubtful})`;
}

function shownTime(cell) {
    const { method, times } = cell.contenders[cell.best_at_error];
    const time = times[suite.targets.indexOf(cell.target)];
    return `${method} (${marks[time.kind] ?? ""}${seconds(time.value)})`;
}

function winnerCells(cell) {
    if (cell.best_at_time === null) return [h("td", { colspan: 5, class: "muted" }, "no light")];
    return [
        h("td", { class: "numbers" }, seconds(cell.seconds)),
        h("td", {}, shownError(cell, cell.best_at_time)),
        h("td", {}, cell.second_at_time === null ? "\u2013" : shownError(cell, cell.second_at_time)),
        h("td", { class: "numbers" }, cell.target === null ? "\u2013" : percent(cell.target)),
        h("td", {}, cell.best_at_error === null ? "none reaches 10 %" : shownTime(cell)),
    ];
}

function rowsOf(scene) {
    if (scene.report === null)
        return [
            h(
                "tr",
                {},
                h("th", { scope: "row" }, scene.name),
                h("td", { colspan: 6, class: "muted" }, `failed: ${scene.failure}`),
            ),
        ];
    return scene.cells.map((cell) =>
        h("tr", {}, h("th", { scope: "row" }, scene.name), h("td", {}, cell.cell), winnerCells(cell)),
    );
}

function sceneLinks() {
    return h(
        "p",
        { id: "scenes" },
        "Everything below is of one scene: ",
        suite.scenes
            .filter((scene) => scene.report !== null)
            .flatMap((scene, i) => [
                i > 0 ? " \u00b7 " : "",
                scene.report === sceneIndex
                    ? h("strong", { "aria-current": "page" }, scene.name)
                    : h("a", { href: `?scene=${scene.report}` }, scene.name),
            ]),
    );
}

function failures() {
    const rows = suite.scenes.flatMap((scene) =>
        scene.failures.map(({ method, reason }) =>
            h("tr", {}, h("th", { scope: "row" }, scene.name), h("td", {}, method), h("td", {}, reason)),
        ),
    );
    if (rows.length === 0) return [];
    const head = ["Scene", "Method", "Failed with"].map((title) => h("th", { scope: "col" }, title));
    return [h("h3", {}, "Methods that failed"), table(head, rows, { id: "failures-table" })];
}

const help =
    "Every method competes in the cells that it computes by its own technique. Times are CPU seconds of the whole " +
    "picture; equal time is that of the finest run of the method that shots take by default, equal error the smallest " +
    "of 10, 5 and 2 % that any of them reaches. \u2020 is an error below the noise of the reference: such errors are not told apart. " +
    "Pictures are kept of each method's finest run, in the cells that it competes in.";

export function addSuite(section, link) {
    if (!suite) return;
    section.hidden = link.hidden = false;
    const titles = ["Scene", "Cell", "Equal time", "Best then", "Second", "Equal error", "First to reach it"];
    const head = titles.map((title) => h("th", { scope: "col" }, title));
    section.append(
        h("p", { class: "muted" }, help),
        table(head, suite.scenes.flatMap(rowsOf), { id: "winners-table" }),
        ...failures(),
        sceneLinks(),
    );
}
