// What was done, and what was turned down.
import { el, shown, signed } from "./dom.js";

/** Rows that are made at a time: thousands at once would make the page slow. */
const PAGE = 100;

export function editsSection(data, viewer) {
  if (!data.run) return null;
  const { edits, mends, feature_edges: features } = data.run;
  const head = ["Edit", "Round", "What", "Removed", "Cost", "Terms of the cost", "Angles, °"];
  const body = el("tbody");
  const more = el("button", { type: "button", click: () => extend() }, "Show more");
  const extend = () => {
    const start = body.children.length;
    body.append(...edits.slice(start, start + PAGE).map((edit, i) => row(edit, start + i + 1, viewer)));
    more.hidden = body.children.length >= edits.length;
  };
  extend();
  const told = [
    ...mends.map((sentence) => `Mended: ${sentence}.`),
    features ? `${features} edges were held as sharp features.` : "No sharp feature was found to hold.",
  ];
  return el("section", { "aria-label": "Edits" }, [
    el("h2", {}, `Edits (${edits.length})`),
    el("p", {}, told.join(" ")),
    edits.length === 0 ? el("p", { class: "faint" }, "No edit was found that improves the mesh.") : el("div", { class: "scroll tall" }, [
      el("table", { class: "edits" }, [
        el("thead", {}, el("tr", {}, head.map((words) => el("th", { scope: "col" }, words)))), body,
      ]),
      more,
    ]),
  ]);
}

function row(edit, number, viewer) {
  const terms = edit.terms.map(([name, cost]) => `${name} ${shown(cost, 3)}`).join(", ");
  const go = el("button", {
    type: "button", class: "link", title: "go there", click: () => viewer.visit(edit, number),
  }, String(number));
  const cells = [go, edit.round, edit.what, shown(edit.gain), edit.cost ? shown(edit.cost, 3) : "–", terms || "–"];
  return el("tr", {}, [
    ...cells.map((cell) => el("td", {}, cell)),
    el("td", { class: edit.angle > 0 ? "worse" : "better" }, signed(Math.round(edit.angle * 10) / 10)),
  ]);
}

export function refusedSection(data) {
  if (!data.run) return null;
  const { lambdas, rows } = data.run.refused;
  const head = ["Reason", ...lambdas.map((rate) => `λ ${shown(rate, 3)}`)];
  const body = rows.map((row) => el("tr", {}, [
    el("th", { scope: "row" }, [row.reason, el("span", { class: "faint" }, ` ${row.why}`)]),
    ...row.counts.map((count) => el("td", { class: "number" }, shown(count))),
  ]));
  return el("section", { "aria-label": "Refused" }, [
    el("h2", {}, "Turned down"),
    el("p", {}, "How many candidates the gate turned down, by reason and by exchange rate λ (degrees of corner angle that an element less may cost). Many were tried again later."),
    rows.length === 0 ? el("p", { class: "faint" }, "None.") : el("div", { class: "scroll" }, el("table", {}, [
      el("thead", {}, el("tr", {}, head.map((words) => el("th", { scope: "col" }, words)))),
      el("tbody", {}, body),
    ])),
  ]);
}
