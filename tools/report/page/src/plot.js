// The log-log plot of error against time.
import uPlot from "uplot";
import { h } from "./dom.js";
import { clocks, measures, number, seconds, withBar } from "./format.js";
import { lawOf, pointsOf, report, seriesColour } from "./report.js";
import { onThemeChange, resolvedColour } from "./theme.js";

const height = () => Math.max(320, Math.min(460, innerHeight * 0.6));

// 1, 2, ... 9 times each power of ten within [low, high].
function decades(low, high) {
    const values = [];
    for (let exponent = Math.floor(Math.log10(low)); exponent <= Math.log10(high); ++exponent)
        for (let digit = 1; digit < 10; ++digit) {
            const value = Number(`${digit}e${exponent}`);
            if (value >= low && value <= high) values.push(value);
        }
    return values;
}

const leading = (value) => Number(value.toExponential()[0]);

// Labels only where they have room: every 1, 2, 5 over few decades, else powers of ten.
function labels(low, high) {
    const few = Math.log10(high / low) < 2.2;
    return (_, splits) =>
        splits.map((value) => ((few ? [1, 2, 5] : [1]).includes(leading(value)) ? number(value) : ""));
}

const rangeOf = (values, margin) => [Math.min(...values) / margin, Math.max(...values) * margin];

export class ErrorPlot {
    constructor() {
        this.legend = h("div", { class: "legend", role: "group", "aria-label": "Methods in the plot" });
        this.frame = h("div", { class: "plot-frame" });
        this.tip = h("div", { class: "tip", role: "status", hidden: true });
        this.element = h("div", { class: "plot" }, this.legend, this.frame);
        this.hidden = new Set();
        this.picked = () => {};
        new ResizeObserver(() => this.resize()).observe(this.frame);
        onThemeChange(() => this.state && this.draw(this.state));
    }

    onPick(listener) {
        this.picked = listener;
    }

    // state: {layer, measure, clock}
    draw(state) {
        this.state = { ...state };
        const scale = measures[state.measure].inPercent ? 100 : 1;
        this.series = report.methods.map((method, index) => ({
            method,
            index,
            points: pointsOf(method, state.layer, state.measure, state.clock).map((p) => ({
                ...p,
                y: scale * p.error,
                // Of the bar; one that reaches 0 ends at the axis.
                low: p.deviation > 0 ? scale * (p.error - p.deviation) : NaN,
                high: p.deviation > 0 ? scale * (p.error + p.deviation) : NaN,
            })),
        }));
        this.floor = state.measure === "rrmse" ? scale * report.reference.noise[state.layer] : NaN;
        this.plot?.destroy();
        this.plot = null;
        this.tip.hidden = true;
        this.drawLegend();
        const all = this.series.flatMap(({ points }) => points);
        if (all.length === 0) {
            this.frame.replaceChildren(
                h("p", { class: "muted" }, "No error of this layer is large enough to be shown."),
            );
            return;
        }
        this.frame.replaceChildren();
        const x = rangeOf(
            all.map((p) => p.seconds),
            1.35,
        );
        const ends = all.flatMap((p) => [p.low, p.high]).filter((end) => end > 0);
        const least = Math.min(...all.map((p) => p.y)) / 4; // a bar that nearly reaches 0 would be all of the axis
        const y = rangeOf(
            [...all.map((p) => p.y), ...ends.map((end) => Math.max(end, least)), ...(this.floor > 0 ? [this.floor] : [])],
            1.35,
        );
        this.plot = new uPlot(this.options(x, y), this.data(), this.frame);
        this.plot.over.append(this.tip);
        this.element.dataset.points = String(all.length);
        this.element.dataset.bars = String(all.filter((p) => p.high > 0).length);
        this.element.dataset.series = String(this.series.filter(({ points }) => points.length > 0).length);
    }

    // One column of times for all series, as uPlot wants it.
    data() {
        return uPlot.join(this.series.map(({ points }) => [points.map((p) => p.seconds), points.map((p) => p.y)]));
    }

    options([left, right], [bottom, top]) {
        const text = resolvedColour("--text"),
            grid = resolvedColour("--grid");
        const font = `12px ${resolvedColour("--font")}`;
        const axis = (label, low, high, size) => ({
            label,
            font,
            labelFont: `600 12px ${resolvedColour("--font")}`,
            stroke: text,
            size,
            labelSize: 24,
            labelGap: 4,
            splits: () => decades(low, high),
            filter: (_, splits) => splits,
            values: labels(low, high),
            grid: { stroke: grid, width: 1 },
            ticks: { stroke: grid, width: 1, size: 5 },
        });
        return {
            width: this.frame.clientWidth,
            height: height(),
            legend: { show: false },
            scales: {
                x: { time: false, distr: 3, range: [left, right] },
                y: { distr: 3, range: [bottom, top] },
            },
            axes: [
                axis(clocks[this.state.clock].axis, left, right, 38),
                axis(measures[this.state.measure].axis, bottom, top, 52),
            ],
            series: [
                {},
                ...this.series.map(({ method, index }) => ({
                    label: method.label,
                    show: !this.hidden.has(method.label),
                    stroke: resolvedColour(`--series-${index % 8}`),
                    width: 2,
                    spanGaps: true,
                    points: { show: true, size: 8, fill: resolvedColour(`--series-${index % 8}`) },
                })),
            ],
            cursor: { drag: { x: false, y: false, setScale: false }, points: { show: false } },
            hooks: {
                drawSeries: [
                    (plot, i) => this.drawContinuation(plot, this.series[i - 1]),
                    (plot, i) => this.drawBars(plot, this.series[i - 1]),
                ],
                draw: [(plot) => this.drawFloor(plot)],
                setCursor: [(plot) => this.showTip(plot)],
                ready: [(plot) => plot.over.addEventListener("click", () => this.pick(plot))],
            },
        };
    }

    // Dotted, from the last point to the right edge: the law of averages, or the floor of a biased method.
    drawContinuation(plot, series) {
        const last = series?.points.at(-1);
        if (!last || this.hidden.has(series.method.label)) return;
        const right = plot.scales.x.max;
        const unbiased = series.method.converges && this.state.measure !== "flip";
        if (!unbiased && series.method.converges) return;
        const floor = Math.min(...series.points.map((p) => p.y));
        const power = this.state.measure === "relmse" ? -1 : -0.5;
        const startup = lawOf(series.method, this.state.layer, this.state.clock)?.startup_seconds ?? 0;
        const after = (x) => (unbiased ? last.y * ((x - startup) / (last.seconds - startup)) ** power : floor);
        const steps = Array.from({ length: 25 }, (_, i) => last.seconds * (right / last.seconds) ** (i / 24));
        this.line(
            plot,
            steps.map((x) => [x, after(x)]),
            `--series-${series.index % 8}`,
            [2, 5],
        );
    }

    // One standard deviation up and down, with caps.
    drawBars(plot, series) {
        if (!series || this.hidden.has(series.method.label)) return;
        const bottom = plot.scales.y.min,
            cap = 5 * devicePixelRatio;
        for (const point of series.points.filter((p) => p.high > 0)) {
            const x = plot.valToPos(point.seconds, "x", true);
            const ends = [Math.max(point.low, bottom), point.high].map((end) => plot.valToPos(end, "y", true));
            this.stroke(plot, `--series-${series.index % 8}`, [], (ctx) => {
                ctx.moveTo(x, ends[0]);
                ctx.lineTo(x, ends[1]);
                for (const y of ends) {
                    ctx.moveTo(x - cap, y);
                    ctx.lineTo(x + cap, y);
                }
            });
        }
    }

    drawFloor(plot) {
        if (!(this.floor > 0)) return;
        this.line(
            plot,
            [
                [plot.scales.x.min, this.floor],
                [plot.scales.x.max, this.floor],
            ],
            "--muted",
            [8, 5],
        );
        const { ctx } = plot,
            ratio = devicePixelRatio;
        ctx.save();
        ctx.fillStyle = resolvedColour("--muted");
        ctx.font = `${12 * ratio}px ${resolvedColour("--font")}`;
        ctx.textAlign = "right";
        ctx.fillText(
            "the reference's own noise",
            plot.bbox.left + plot.bbox.width - 8 * ratio,
            plot.valToPos(this.floor, "y", true) - 6 * ratio,
        );
        ctx.restore();
    }

    line(plot, points, colour, dash) {
        this.stroke(plot, colour, dash, (ctx) => {
            for (const [x, y] of points) ctx.lineTo(plot.valToPos(x, "x", true), plot.valToPos(y, "y", true));
        });
    }

    // What `draw` adds to the path, within the axes.
    stroke(plot, colour, dash, draw) {
        const { ctx, bbox } = plot;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        ctx.beginPath();
        ctx.strokeStyle = resolvedColour(colour);
        ctx.lineWidth = 1.5 * devicePixelRatio;
        ctx.setLineDash(dash.map((length) => length * devicePixelRatio));
        draw(ctx);
        ctx.stroke();
        ctx.restore();
    }

    // The point under the cursor, within a finger's width.
    nearest(plot) {
        const { left, top } = plot.cursor;
        let best = null,
            least = 24;
        for (const series of this.series) {
            if (this.hidden.has(series.method.label)) continue;
            for (const point of series.points) {
                const x = plot.valToPos(point.seconds, "x"),
                    y = plot.valToPos(point.y, "y");
                const distance = Math.hypot(x - left, y - top);
                if (distance < least) {
                    least = distance;
                    best = { series, point, x, y };
                }
            }
        }
        return best;
    }

    showTip(plot) {
        const found = plot.cursor.left >= 0 ? this.nearest(plot) : null;
        this.tip.hidden = !found;
        plot.over.style.cursor = found ? "pointer" : "";
        if (!found) return;
        const { series, point, x, y } = found;
        this.tip.replaceChildren(
            h("strong", {}, series.method.label),
            h("span", {}, point.run.label),
            h(
                "span",
                {},
                `${withBar(this.state.measure, point.error, point.deviation)} in ${seconds(point.seconds)}`,
            ),
        );
        this.tip.classList.toggle("to-left", x > plot.over.clientWidth / 2);
        this.tip.style.setProperty("left", `${x}px`);
        this.tip.style.setProperty("top", `${y}px`);
    }

    pick(plot) {
        const found = this.nearest(plot);
        if (found) this.picked(found.point.run.id);
    }

    drawLegend() {
        this.legend.replaceChildren(
            ...this.series.map(({ method, index, points }) =>
                h(
                    "button",
                    {
                        type: "button",
                        title: "Show or hide",
                        "aria-pressed": String(!this.hidden.has(method.label)),
                        onclick: (event) => this.toggle(method.label, index, event.currentTarget),
                    },
                    h("i", { class: "swatch", style: { background: seriesColour(index) } }),
                    method.label,
                    points.length === 0 ? h("small", {}, "nothing to show") : null,
                ),
            ),
        );
    }

    toggle(label, index, button) {
        const show = this.hidden.delete(label) || (this.hidden.add(label), false);
        button.setAttribute("aria-pressed", String(show));
        this.plot?.setSeries(index + 1, { show });
    }

    resize() {
        const width = this.frame.clientWidth;
        if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: height() });
    }
}
