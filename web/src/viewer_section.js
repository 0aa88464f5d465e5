// The two views with their tools, and what is known about the element that was chosen.
import { el, shown, signed } from "./dom.js";
import { HEAT_CSS, MINUS, MINUS_MORE, PLUS, PLUS_MORE, T_JUNCTION } from "./palette.js";
import { describe, elementAt, placeOf, tour } from "./inspect.js";
import { Viewer } from "./viewer.js";

/** The section, `start` to draw it once it is on the page, and what other sections ask of it. */
export function viewerSection(data) {
  return new ViewerSection(data);
}

class ViewerSection {
  constructor(data) {
    this.data = data;
    this.tours = new Map();
    this.canvas = el("canvas", {
      tabindex: 0,
      "aria-label": "Meshes in 3D. Drag to turn, arrow keys to move, n and p for the next and previous irregular element, r to reset",
      keydown: (event) => this.#key(event),
    });
    this.active = 0;
    this.panes = [0, Math.min(1, data.meshes.length - 1)].map((m, i) => this.#pane(m, i));
    this.info = el("div", { class: "info", id: "info", "aria-live": "polite" }, [
      el("p", { class: "faint" }, "Click a vertex or a face to see its numbers. Elements are counted from 1, as in OBJ files."),
    ]);
    this.legend = el("div", { class: "legend" });
    this.stage = el("div", { class: "stage" }, [
      this.canvas,
      el("div", { class: "panes" }, this.panes.map((pane) => pane.element)),
    ]);
    this.element = el("section", { class: "viewer", "aria-label": "Meshes" }, [
      this.#toolbar(), this.stage, this.legend, this.info, ...this.#notes(),
    ]);
  }

  /** Draws; the section must be on the page. */
  start() {
    try {
      this.viewer = new Viewer(this.canvas, this.panes, (i, hit) => this.#picked(i, hit));
    } catch (error) {
      this.stage.replaceChildren(el("p", { class: "notice" },
        `The meshes cannot be drawn: this browser gives no WebGL (${error.message}). All numbers are below.`));
      return;
    }
    this.panes.forEach((pane, i) => this.#setMesh(i, pane.chosen));
    this.viewer.resize();
    this.viewer.reset();
    this.#drawLegend();
  }

  themeChanged() {
    this.viewer?.apply();
  }

  /** Goes to where an edit was made, in both views, and says what it was. */
  visit(edit, number) {
    if (!this.viewer) return;
    const { place } = edit;
    const { surface } = this.viewer.layersOf(1);
    const v = surface.nearestVertex(place);
    this.viewer.goTo(place, surface.vertexNormals.subarray(3 * v, 3 * v + 3), surface.meanEdge);
    this.viewer.choose([0, 1], [place]);
    this.#tell(`Edit ${number}`, edit.what, [
      ["elements removed", shown(edit.gain)],
      ["growth of angles", `${signed(Math.round(edit.angle * 10) / 10)}°`],
      ...edit.terms.map(([name, cost]) => [`cost of ${name}`, shown(cost, 3)]),
    ]);
    this.element.scrollIntoView({ block: "start" });
  }

  #pane(chosen, i) {
    const choices = this.data.meshes.map((mesh, m) =>
      el("option", { value: m, selected: m === chosen }, mesh.name));
    const select = el("select", {
      "aria-label": `Mesh on the ${["left", "right"][i]}`,
      change: () => this.#setMesh(i, Number(select.value)),
    }, choices);
    const count = el("span", { class: "count" });
    const step = (by, words, sign) =>
      el("button", { type: "button", title: words, "aria-label": words, click: () => this.#step(i, by) }, sign);
    const element = el("div", { class: "pane" }, [
      el("div", { class: "pane-head" }, [
        select, step(-1, "previous irregular element", "‹"), count, step(1, "next irregular element", "›"),
      ]),
    ]);
    return { element, count, chosen, mesh: null, stop: -1 };
  }

  #toolbar() {
    const choice = (label, name, options, change) => el("label", {}, [
      label, " ",
      el("select", { name, change: (event) => change(event.target.value) },
        options.map(([value, words]) => el("option", { value }, words))),
    ]);
    const colours = [["", "irregular elements"], ...this.data.fields.map((f) => [f.key, f.label])];
    const thinned = this.data.meshes.some((mesh) => mesh.thinned);
    return el("div", { class: "toolbar", role: "toolbar" }, [
      choice("Colour", "colour", colours, (key) => this.#colour(key)),
      choice("Shading", "shading", [["flat", "flat"], ["smooth", "smooth"], ["wireframe", "wireframe"]],
        (shading) => this.viewer?.set({ shading })),
      choice("Domain", "domain",
        thinned ? [["", "mesh"]] : [["", "mesh"], ["lifted", "√CC (all quads)"]],
        (value) => { this.viewer?.set({ liftedDomain: value !== "" }); this.#drawLegend(); }),
      choice("Up", "up", [["y", "y"], ["z", "z"]], (up) => this.viewer?.reset(up)),
      el("button", { type: "button", name: "reset", click: () => this.viewer?.reset() }, "Reset view"),
      el("span", { class: "faint hint" }, "drag: turn · right drag or two fingers: move · wheel or pinch: zoom · keys: n, p, r, arrows"),
    ]);
  }

  /** Says where not everything is shown. */
  #notes() {
    return this.data.meshes.filter((mesh) => mesh.thinned).map((mesh) => el("p", { class: "notice" },
      `${mesh.name} has ${shown(mesh.face_count)} faces. To stay usable, the view shows ` +
      `${shown(mesh.offsets.length - 1)} faces of it, thinned out; irregular elements are all there, and ` +
      "all numbers are those of the whole mesh."));
  }

  #setMesh(i, m) {
    const pane = this.panes[i];
    pane.chosen = m;
    pane.stop = -1;
    if (!this.viewer) return;
    this.viewer.choose([], null);
    this.viewer.setMesh(i, this.data.meshes[m]);
    pane.count.textContent = `${this.#tour(i).length} irregular`;
  }

  #tour(i) {
    const { mesh, surface } = this.viewer.layersOf(i);
    if (!this.tours.has(mesh)) this.tours.set(mesh, tour(surface));
    return this.tours.get(mesh);
  }

  #step(i, by) {
    if (!this.viewer) return;
    this.active = i;
    const pane = this.panes[i];
    const stops = this.#tour(i);
    if (stops.length === 0) return;
    pane.stop = pane.stop < 0 && by < 0 ? stops.length - 1 : (pane.stop + by + stops.length) % stops.length;
    pane.count.textContent = `${pane.stop + 1} of ${stops.length}`;
    this.#select(i, stops[pane.stop]);
    const { surface } = this.viewer.layersOf(i);
    const { place, normal } = placeOf(surface, stops[pane.stop]);
    this.viewer.goTo(place, normal, surface.meanEdge);
  }

  /** Keys act on the view that was used last. */
  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const steps = { n: 1, p: -1 };
    if (event.key in steps) this.#step(this.active, steps[event.key]);
    else if (event.key === "r") this.viewer?.reset();
  }

  #picked(i, hit) {
    this.active = i;
    if (hit) this.#select(i, elementAt(this.viewer.layersOf(i).surface, hit));
    else {
      this.viewer.choose([i], null);
      this.info.replaceChildren(el("p", { class: "faint" }, "Nothing there."));
    }
  }

  #select(i, element) {
    const { surface } = this.viewer.layersOf(i);
    const { title, facts } = describe(surface, element, this.data.fields);
    this.viewer.choose([i], placeOf(surface, element).outline);
    this.#tell(title, this.panes[i].mesh.name, facts);
  }

  #tell(title, more, facts) {
    this.info.replaceChildren(
      el("h3", {}, [title, " ", el("span", { class: "faint" }, more)]),
      el("dl", {}, facts.flatMap(([term, value]) => [el("dt", {}, term), el("dd", {}, value)])),
    );
  }

  #colour(key) {
    this.field = this.data.fields.find((field) => field.key === key) ?? null;
    this.viewer?.set({ field: this.field });
    this.#drawLegend();
  }

  #drawLegend() {
    const lifted = this.viewer?.options.liftedDomain;
    if (this.field && !lifted) {
      this.legend.replaceChildren(
        el("span", {}, shown(this.field.low, 3)),
        el("span", { class: "scale", style: `background:${HEAT_CSS}` }),
        el("span", {}, `${shown(this.field.high, 3)} ${this.field.unit}`),
        el("span", { class: "faint" }, `${this.field.label}, ${this.field.better} is better; grey where it is undefined`),
      );
      return;
    }
    const entry = (colour, words, shape = "disc") => el("span", { class: "key" }, [
      el("i", { class: shape, style: `--c:rgb(${colour})` }), words,
    ]);
    const line = (role, words) => el("span", { class: "key" }, [el("i", { class: `line ${role}` }), words]);
    const any = (of) => this.data.meshes.some(of);
    this.legend.replaceChildren(...[
      entry(PLUS_MORE, "index ≥ +2"),
      entry(PLUS, "+1: valence or degree 3"),
      entry(MINUS, "−1: valence or degree 5"),
      entry(MINUS_MORE, "≤ −2"),
      any((m) => m.tJunctions.length) && entry(T_JUNCTION, "T-junction", "ring"),
      any((m) => m.sharpEdges.length) && line("sharp", "sharp feature"),
      any((m) => m.boundaryEdges.length) && line("boundary", "boundary"),
      lifted && el("span", { class: "faint" }, "every edge is a quad now; discs were vertices, diamonds were faces"),
    ].filter(Boolean));
  }
}
