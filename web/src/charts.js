// Histograms, and how irregularity fell from edit to edit.
import { el, shown, svg } from "./dom.js";

const [WIDTH, HEIGHT] = [460, 220];
const BOX = { left: 52, right: 8, top: 10, bottom: 40 };

export function chartsSection(data, viewer) {
  const charts = data.histograms.map((histogram) => histogramChart(histogram, data.meshes));
  if (data.run?.edits.length) charts.push(curveChart(data.run, viewer));
  return el("section", { "aria-label": "Distributions" }, [
    el("h2", {}, "Distributions"),
    el("div", { class: "charts" }, charts),
  ]);
}

/** A picture with axes; `x` and `y` go from data to the drawing. */
function frame([high, highest], [xWords, yWords]) {
  const inner = [WIDTH - BOX.left - BOX.right, HEIGHT - BOX.top - BOX.bottom];
  const x = (value) => BOX.left + (value / high) * inner[0];
  const y = (value) => BOX.top + (1 - value / highest) * inner[1];
  const text = (at, words, more = {}) => svg("text", { x: at[0], y: at[1], ...more }, words);
  const axes = [];
  for (const value of ticks(highest)) {
    axes.push(svg("line", { class: "grid", x1: x(0), x2: x(high), y1: y(value), y2: y(value) }));
    axes.push(text([x(0) - 6, y(value) + 4], shown(value), { "text-anchor": "end" }));
  }
  for (const value of ticks(high)) {
    axes.push(text([x(value), y(0) + 16], shown(value), { "text-anchor": "middle" }));
  }
  axes.push(text([x(high / 2), HEIGHT - 6], xWords, { "text-anchor": "middle" }));
  axes.push(text([12, y(highest / 2)], yWords, {
    "text-anchor": "middle", transform: `rotate(-90 12 ${y(highest / 2)})`,
  }));
  const drawing = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img" }, axes);
  return { drawing, x, y };
}

/** Round numbers from 0, about five of them. */
function ticks(high) {
  const rough = high / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough) ?? rough;
  return Array.from({ length: Math.floor(high / step + 1e-9) + 1 }, (_, i) => i * step);
}

function histogramChart(histogram, meshes) {
  const shares = histogram.counts.map((counts) => {
    const all = counts.reduce((a, b) => a + b, 0) || 1;
    return counts.map((c) => (100 * c) / all);
  });
  const highest = Math.max(...shares.flat(), 1e-9);
  const { drawing, x, y } = frame([histogram.high, highest], [`${histogram.label}, ${histogram.unit}`, "share, %"]);
  shares.forEach((bins, m) => {
    const width = histogram.high / bins.length;
    const points = bins.flatMap((share, i) => [[x(i * width), y(share)], [x((i + 1) * width), y(share)]]);
    const outline = points.map((p) => p.map((c) => c.toFixed(1)).join(" ")).join("L");
    const base = `M${x(0)} ${y(0)}L${outline}L${x(histogram.high)} ${y(0)}`;
    drawing.append(svg("path", { class: `series s${m % 6}`, d: base }));
  });
  drawing.setAttribute("aria-label", `Histogram of ${histogram.label}`);
  return el("figure", {}, [drawing, key(meshes)]);
}

function key(meshes) {
  return el("figcaption", {}, meshes.map((mesh, m) => el("span", { class: "key" }, [
    el("i", { class: `swatch s${m % 6}` }), mesh.name,
  ])));
}

function curveChart(run, viewer) {
  const { curve, edits } = run;
  const { drawing, x, y } = frame([edits.length, Math.max(...curve, 1)], ["edits made", "irregularity E"]);
  const points = curve.map((e, i) => `${x(i).toFixed(1)} ${y(e).toFixed(1)}`).join("L");
  const dot = svg("circle", { class: "dot", r: 4, cx: x(0), cy: y(curve[0]) });
  const caption = el("figcaption", { class: "faint" }, "At features and boundaries, irregular is what does not suit the angle there. Click: go to the edit.");
  const numberAt = (event) => {
    const box = drawing.getBoundingClientRect();
    const at = ((event.clientX - box.left) / box.width) * WIDTH - BOX.left;
    const share = at / (WIDTH - BOX.left - BOX.right);
    return Math.min(edits.length, Math.max(1, Math.round(share * edits.length)));
  };
  drawing.append(svg("path", { class: "curve", d: `M${points}` }), dot);
  drawing.addEventListener("pointermove", (event) => {
    const i = numberAt(event);
    dot.setAttribute("cx", x(i));
    dot.setAttribute("cy", y(curve[i]));
    caption.textContent = `edit ${i}: ${edits[i - 1].what}, E = ${curve[i]}`;
  });
  drawing.addEventListener("click", (event) => {
    const number = numberAt(event);
    viewer.visit(edits[number - 1], number);
  });
  drawing.setAttribute("aria-label", "Irregularity against the number of edits");
  return el("figure", { class: "clickable" }, [drawing, caption]);
}
