// The data that the program put into the page.
import { clocks } from "./format.js";

const parse = (id) => JSON.parse(document.getElementById(id).textContent);

// Of a page with several scenes: the suite, and which of its scenes the address names (?scene=2, from 0).
export const suite = document.getElementById("suite-data") ? parse("suite-data") : null;
const scenes = suite ? suite.scenes.filter((scene) => scene.report !== null).length : 0;
const asked = Number(new URLSearchParams(location.search).get("scene") ?? 0);
export const sceneIndex = Number.isInteger(asked) && asked >= 0 && asked < scenes ? asked : 0;

const ofScene = (id) => parse(suite ? `${id}-${sceneIndex}` : id);

export const report = ofScene("report-data");
export const pictures = ofScene("report-pictures");

export const reference = "reference"; // id of its pictures

const runs = new Map(report.methods.flatMap((method) => method.runs.map((run) => [run.id, { method, run }])));

export const findRun = (id) => runs.get(id);

// Pages with several scenes have pictures of some runs only.
export const hasPicture = (id) => pictures.images[id] !== undefined;
export const picturedRuns = (method) => method.runs.filter((run) => hasPicture(run.id));

export const layers = report.layers;

// Measures that were taken of this report's runs, the one that counts first.
export const takenMeasures = ["noise_free", "rrmse", "relmse", "mape", "flip"].filter((measure) =>
    report.methods.some((method) => method.runs.some((run) => typeof run.errors[""]?.[measure] === "number")),
);

export function nameOf(id) {
    if (id === reference) return "Reference";
    const { method, run } = runs.get(id);
    return `${method.label}, ${run.label}`;
}

// Standard deviation of a measure from repeat to repeat; null where all repeats gave the same picture.
export const spreadOf = (run, layer, measure) => run.errors[layer]?.spread?.[measure] ?? null;

export const aboutBars =
    report.time.repeats > 1
        ? `Errors are means of ${report.time.repeats} renders with other seeds, \u00b1 the standard deviation of one ` +
          `render; that of the mean is ${Math.sqrt(report.time.repeats).toPrecision(2)} times smaller. A layer without ` +
          "a bar was the same picture every time. What the reference errs by is the same in all repeats, and in no bar."
        : "";

// The points of a method that a plot can show: [{run, seconds, error, deviation}], by time. An error of 0 is too small to measure
// against the reference, and cannot be drawn on a logarithmic axis.
export function pointsOf(method, layer, measure, clock) {
    return method.runs
        .map((run) => ({
            run,
            seconds: run[clocks[clock].key],
            error: run.errors[layer]?.[measure],
            deviation: spreadOf(run, layer, measure),
        }))
        .filter((point) => point.seconds > 0 && point.error > 0)
        .sort((a, b) => a.seconds - b.seconds);
}

export const lawOf = (method, layer, clock) => method.convergence[layer]?.[clock];

export const seriesColour = (index) => `var(--series-${index % 8})`;
