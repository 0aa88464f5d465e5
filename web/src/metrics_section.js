// The table of metrics.
import { el } from "./dom.js";

export function metricsSection(data) {
  const two = data.meshes.length === 2;
  const head = el("tr", {}, [
    el("th", { scope: "col" }, "Metric"),
    ...data.meshes.map((mesh) => el("th", { scope: "col", class: "number" }, mesh.name)),
    ...(two ? [el("th", { scope: "col" }, "Change")] : []),
  ]);
  const rows = [];
  let group = null;
  for (const row of data.table) {
    if (row.group !== group) {
      group = row.group;
      const span = data.meshes.length + (two ? 2 : 1);
      rows.push(el("tr", { class: "group" }, el("th", { scope: "rowgroup", colspan: span }, group)));
    }
    rows.push(line(row, two));
  }
  return el("section", { "aria-label": "Metrics" }, [
    el("h2", {}, "Metrics"),
    el("div", { class: "scroll" }, el("table", {}, [el("thead", {}, head), el("tbody", {}, rows)])),
    el("p", { class: "faint" }, two ? "" : "The best value of each row is marked ★."),
  ]);
}

function line(row, two) {
  const best = (i) => !two && row.best.includes(i);
  const values = row.values.map((value, i) =>
    el("td", { class: best(i) ? "number best" : "number" }, best(i) ? `★ ${value}` : value));
  const change = two
    ? [el("td", { class: row.change?.judgement ?? "" }, row.change ? `${row.change.extent} ${row.change.judgement}` : "")]
    : [];
  const name = [row.label, row.unit && el("span", { class: "faint" }, ` ${row.unit}`)].filter(Boolean);
  return el("tr", {}, [el("th", { scope: "row" }, name), ...values, ...change]);
}
