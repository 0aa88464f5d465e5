// Title, theme switch, and the numbers one looks at first.
import { el } from "./dom.js";
import { isDark } from "./palette.js";

export function header(data, themeChanged) {
  const words = () => (isDark() ? "Light" : "Dark");
  const button = el("button", {
    type: "button",
    name: "theme",
    click: () => {
      document.documentElement.dataset.theme = isDark() ? "light" : "dark";
      button.textContent = words();
      themeChanged();
    },
  }, words());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    button.textContent = words();
    themeChanged();
  });
  return el("header", {}, [
    el("h1", {}, data.title),
    el("span", { class: "faint" }, `quadmend ${data.version}`),
    button,
  ]);
}

const FIRST = ["irregular_elements", "t_junctions", "fig10_mean", "scaled_jacobian_min", "hausdorff", "rms"];

/** Before → after of the most telling metrics; nothing for more than two meshes. */
export function tiles(data) {
  if (data.meshes.length !== 2) return null;
  const rows = FIRST.map((key) => data.table.find((row) => row.key === key)).filter(Boolean);
  return el("div", { class: "tiles" }, rows.map((row) => el("div", { class: `tile ${row.change?.judgement ?? ""}` }, [
    el("div", { class: "faint" }, row.label),
    el("div", { class: "big" }, [row.values[0], " → ", el("b", {}, `${row.values[1]}${row.unit === "°" ? "°" : ""}`)]),
    el("div", { class: "change" }, row.change ? `${row.change.extent} ${row.change.judgement}` : "–"),
  ])));
}
