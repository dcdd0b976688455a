// The panel of the labels of a label map, or of a volume's mask. Each label has an eye, a colour, a name and
// an opacity. The panel shows the chosen volume if the volume has labels, else the first volume that has
// labels.

import { hexOf, linearOf } from "./color.js";
import { button, isActive, make, row, section, slider } from "./controls.js";

const MANY = 12; // number of labels above which they can be searched

const nameOf = (label) => label.name ?? `label ${label.value}`;

// Makes the row of one label. get(): returns the label. change(name, part): changes the label.
// alone(): hides all other labels.
function labelRow({ get, change, alone }) {
  const name = nameOf(get());
  const eye = button("", () => change("eye", { visible: get().visible === false }), { class: "eye", "aria-label": `Show ${name}` });
  const shade = make("input", { type: "color", "aria-label": `Colour of ${name}`, oninput: () => change("color", { color: linearOf(shade.value) }) });
  const only = button(name, alone, { class: "file", title: `Show ${name} alone`, "aria-label": `Show ${name} alone` });
  const opacity = make("input", {
    type: "number", min: 0, max: 1, step: 0.1, "aria-label": `Opacity of ${name}`,
    onchange: () => {
      if (opacity.value !== "") change("opacity", { opacity: Math.min(Math.max(+opacity.value, 0), 1) });
      update();
    },
  });
  let drawn = null;
  function update() {
    const label = get();
    if (label === drawn) return; // a row is drawn anew only if its label has changed
    drawn = label;
    eye.setAttribute("aria-pressed", String(label.visible !== false));
    shade.value = hexOf(label.color);
    if (!isActive(opacity)) opacity.value = +(label.opacity ?? 1).toFixed(3);
  }
  return { name, element: make("li", {}, eye, shade, only, opacity), update };
}

export function labelPanel({ store, current, report }) {
  const { element, body } = section("Labels");
  const volumes = () => store.scene.volumes;
  const labelsOf = (volume) => volume?.labels ?? volume?.mask?.labels;
  const index = () => (labelsOf(volumes()[current.volume]) ? current.volume : volumes().findIndex(labelsOf));
  const labels = () => labelsOf(volumes()[index()]);
  const mask = () => (volumes()[index()]?.labels ? undefined : volumes()[index()]?.mask);
  const rest = slider({
    label: "Rest", path: () => `volumes.${index()}.mask.rest`, low: 0, high: 1, title: "The opacity of what lies outside the labels",
    get: () => mask()?.rest ?? 0, set: (value) => setMask("rest", { rest: value }),
  });
  let rows = [];
  const setMask = (name, part) => store.changeVolume(index(), `mask ${name}`, (v) => ({ ...v, mask: { ...v.mask, ...part } }));
  function setAll(name, change) {
    if (mask()) setMask(`labels ${name}`, { labels: mask().labels.map(change) });
    else store.changeVolume(index(), `labels ${name}`, (v) => ({ ...v, labels: v.labels.map(change) }));
  }

  // A label of a mask shows the volume's colours until the user gives the label a colour, which
  // sets `tint` to 1.
  function change(number, name, part) {
    const tinted = mask() && part.color ? { ...part, tint: 1 } : part;
    const changed = labels().map((label, n) => (n === number ? { ...label, ...tinted } : label));
    if (changed.some((label) => label.visible !== false)) setAll(`${number} ${name}`, (_, n) => changed[n]);
    else report("One label has to show. Its name shows a label alone.");
  }

  function build() {
    element.hidden = !labels();
    rows = [];
    if (element.hidden) return;
    rows = labels().map((_, n) => labelRow({
      get: () => labels()[n], change: (name, part) => change(n, name, part),
      alone: () => setAll(`alone ${n}`, (label, m) => ({ ...label, visible: m === n })),
    }));
    const search = make("input", {
      type: "search", "aria-label": "Search labels", placeholder: "search",
      oninput: () => rows.forEach((one) => { one.element.hidden = !one.name.toLowerCase().includes(search.value.toLowerCase()); }),
    });
    const all = button("show all", () => setAll("all", (label) => ({ ...label, visible: true })));
    body.replaceChildren(row("", make("span", { class: "pair" }, ...(rows.length > MANY ? [search] : []), all)),
      make("ul", { class: "files labels" }, ...rows.map((one) => one.element)), ...(mask() ? [rest.element] : []));
    rows.forEach((one) => one.update());
    rest.update();
  }
  const update = () => {
    if (rows.length !== (labels()?.length ?? 0)) build();
    else [...rows, rest].forEach((one) => one.update());
  };
  build();
  return { element, update, rebuild: build };
}
