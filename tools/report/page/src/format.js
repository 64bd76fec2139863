// Numbers and names for people.

const digits = (value, count) => {
    const rounded = Number(value.toPrecision(count));
    // Plain digits as long as they are readable.
    return Math.abs(rounded) >= 1e6 || (rounded !== 0 && Math.abs(rounded) < 1e-4)
        ? rounded
              .toExponential(Math.max(count - 1, 0))
              .replace("e-", "e\u2212")
              .replace("e+", "e")
        : String(Number(rounded)).replace("-", "\u2212");
};

export const known = (value) => typeof value === "number" && Number.isFinite(value);

export const number = (value, count = 3) => (known(value) ? digits(value, count) : "\u2013");

export const percent = (share, count = 3) => (known(share) ? `${digits(100 * share, count)} %` : "\u2013");

export function seconds(value) {
    if (!known(value)) return "\u2013";
    if (value < 600) return `${digits(value, 3)} s`;
    if (value < 7200) return `${digits(value / 60, 3)} min`;
    return value < 172800 ? `${digits(value / 3600, 3)} h` : `${digits(value / 86400, 3)} d`;
}

export const mebibytes = (bytes) => (bytes > 0 ? `${number(bytes / 1048576)} MiB` : "\u2013");

export const times = (ratio) => (known(ratio) ? `${number(ratio, ratio < 100 ? 2 : 3)}\u00d7` : "\u2013");

export const layerTitle = (layer) => (layer === "" ? "Beauty" : layer);

export const clocks = {
    wall: { key: "wall_seconds", title: "Wall time", text: "wall time", axis: "wall time [s]" },
    cpu: { key: "cpu_seconds", title: "CPU time", text: "CPU time", axis: "CPU time of all threads [s]" },
};

// Every measure the program took; those in percent are relative to the reference.
export const measures = {
    noise_free: {
        title: "rRMSE, noise-free",
        axis: "relative RMS error, free of the reference's noise [%]",
        inPercent: true,
        help: "square root of sum (I-A)(I-B) / sum A B over two independent halves A, B of the reference",
    },
    rrmse: {
        title: "rRMSE",
        axis: "relative RMS error [%]",
        inPercent: true,
        help: "||I-R|| / ||R|| over all pixels and channels; holds the reference's noise too",
    },
    relmse: {
        title: "relMSE",
        axis: "relMSE, 0.1 % of the pixels trimmed",
        inPercent: false,
        help: "mean of (I-R)\u00b2 / (R\u00b2 + \u03b5\u00b2), \u03b5 = 1 % of the mean; the worst 0.1 % of the pixels left out",
    },
    mape: {
        title: "MAPE",
        axis: "mean absolute relative error [%]",
        inPercent: true,
        help: "mean of |I-R| / (|R| + \u03b5), \u03b5 = 1 % of the mean",
    },
    flip: {
        title: "HDR-FLIP",
        axis: "mean HDR-FLIP error, 0 to 1",
        inPercent: false,
        help: "perceived difference over all exposures, mean over the picture",
    },
};

export const shown = (measure, value) => (measures[measure].inPercent ? percent(value) : number(value));

// The standard deviation behind a mean, in the same unit; nothing where there is none.
export const bar = (measure, deviation) =>
    known(deviation) ? ` \u00b1 ${number(measures[measure].inPercent ? 100 * deviation : deviation, 2)}` : "";

// A mean and its bar: "3.21 ± 0.4 %".
export const withBar = (measure, value, deviation) => {
    const text = shown(measure, value);
    return known(deviation) ? text.replace(/( %)?$/, (unit) => `${bar(measure, deviation)}${unit}`) : text;
};
