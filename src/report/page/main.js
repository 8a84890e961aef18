// The page: sections in the order of a reader's questions.

import { curvesSection } from "./curves.js";
import { correlationSection, misfitSection, reflectanceSection, selectionSection, sourceSection } from "./details.js";
import { report } from "./data.js";
import { el } from "./dom.js";
import { lobesSection } from "./lobes.js";
import { mapsSection } from "./maps.js";
import { profilesSection } from "./profiles.js";
import { header, notesSection, parametersSection } from "./summary.js";

const sections = [
  parametersSection(), curvesSection(), mapsSection(), lobesSection(), misfitSection(), notesSection(),
  reflectanceSection(), correlationSection(), profilesSection(), selectionSection(), sourceSection(),
].filter(Boolean);

const nav = el("nav", { "aria-label": "Sections" }, el("ul", {}, sections.map((section) =>
  el("li", {}, el("a", { href: `#${section.id}` }, section.querySelector("h2").textContent)))));

document.getElementById("page").replaceWith(
  el("main", { id: "main", tabindex: "-1" }, header(), nav, sections,
    report.plots.note ? el("p", { class: "caption" }, `Of many channels, ${report.plots.note}.`) : null),
);

// Paper cannot be opened: the file stays out of it.
window.addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = false;
});
document.documentElement.dataset.ready = "yes";
