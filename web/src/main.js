// The page: builds the parts from the data that the file carries.
import "./style.css";
import { readData } from "./data.js";
import { el } from "./dom.js";
import { header, tiles } from "./header.js";
import { viewerSection } from "./viewer_section.js";
import { metricsSection } from "./metrics_section.js";
import { chartsSection } from "./charts.js";
import { editsSection, refusedSection } from "./edits_section.js";
import { aboutSection } from "./about_section.js";

const data = readData();
const root = document.getElementById("report");
const viewer = viewerSection(data);
root.append(
  header(data, () => viewer.themeChanged()),
  el("main", {}, [
    tiles(data),
    viewer.element,
    metricsSection(data),
    chartsSection(data, viewer),
    editsSection(data, viewer),
    refusedSection(data),
    aboutSection(data),
  ].filter(Boolean)),
);
viewer.start();
