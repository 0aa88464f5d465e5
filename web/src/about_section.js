// Where everything comes from: files, version, configuration, timings.
import { el, shown } from "./dom.js";

export function aboutSection(data) {
  const files = [
    ...data.meshes.map((mesh) => [mesh.file, mesh.sha256]),
    ...(data.reference ? [[`${data.reference.file} (reference)`, data.reference.sha256]] : []),
  ];
  return el("section", { "aria-label": "About" }, [
    el("h2", {}, "How this was made"),
    el("p", {}, `quadmend ${data.version}`),
    el("div", { class: "scroll" }, el("table", {}, [
      el("thead", {}, el("tr", {}, [el("th", { scope: "col" }, "File"), el("th", { scope: "col" }, "SHA-256")])),
      el("tbody", {}, files.map(([file, hash]) => el("tr", {}, [
        el("td", {}, file), el("td", { class: "hash" }, hash ?? "written by this run"),
      ]))),
    ])),
    ...(data.run ? runDetails(data.run) : []),
  ]);
}

function runDetails(run) {
  const total = run.timings.reduce((sum, t) => sum + t.seconds, 0);
  const changed = run.config.flatMap((s) => s.knobs).filter((k) => k.changed).length;
  return [
    el("details", {}, [
      el("summary", {}, `Timings: ${shown(total, 3)} s`),
      el("table", {}, el("tbody", {}, run.timings.map((t) => el("tr", {}, [
        el("th", { scope: "row" }, t.phase), el("td", { class: "number" }, `${t.seconds.toFixed(2)} s`),
      ])))),
    ]),
    el("details", {}, [
      el("summary", {}, `Configuration: ${changed === 0 ? "all defaults" : `${changed} changed from the defaults`}`),
      ...run.config.map((section) => el("div", {}, [
        el("h3", {}, [`[${section.name}]`, el("span", { class: "faint" }, ` ${section.about}`)]),
        el("table", {}, el("tbody", {}, section.knobs.map((knob) => el("tr", { class: knob.changed ? "changed" : "" }, [
          el("th", { scope: "row" }, knob.key),
          el("td", { class: "number" }, `${knob.value}${knob.changed ? " (changed)" : ""}`),
          el("td", { class: "faint" }, `${knob.unit}: ${knob.meaning}`),
        ])))),
      ])),
    ]),
  ];
}
