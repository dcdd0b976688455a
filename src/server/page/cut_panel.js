// The panels of the cuts of a volume, and of the cuts of the scene, which cut all volumes. Cuts are planes,
// boxes and spheres; each cut has fields for its numbers and a switch. A cut that is switched off is kept
// in the page's state and is not part of the scene.

import { corners, middle, placed, unplaced, worldBox } from "./boxes.js";
import { button, isActive, make, row, section, segments, select, shortNumber, tabs, toggle } from "./controls.js";
import { add, scale, subtract, withoutErrors } from "./vector.js";

const PARTS = { plane: [["point", "Point"], ["normal", "Direction"]], box: [["min", "Least"], ["max", "Greatest"]], sphere: [["center", "Centre"], ["radius", "Radius"]] };

// Returns whether an object, for example from a session's file, has all numbers of a cut.
const isComplete = (cut) => Object.hasOwn(PARTS, cut?.type) && PARTS[cut.type].every(([key]) => {
  const values = [cut[key]].flat();
  return values.length === (key === "radius" ? 1 : 3) && values.every(Number.isFinite);
});

// Makes a new cut. A new box removes the eighth of the whole box that is nearest to the eye. A new sphere removes the
// matter in the middle of the side that faces the eye.
function newCut(type, whole, eye) {
  const sides = whole.max.map((end, k) => end - whole.min[k]), longest = Math.max(...sides);
  const at = withoutErrors(middle(whole), longest), towards = subtract(eye, at);
  if (type === "plane") return { type, point: at, normal: [1, 0, 0] };
  if (type === "box") return { type, min: at.map((x, k) => (towards[k] < 0 ? whole.min[k] - sides[k] / 10 : x)), max: at.map((x, k) => (towards[k] < 0 ? x : whole.max[k] + sides[k] / 10)) };
  const out = Math.min(...towards.map((x, k) => sides[k] / 2 / Math.max(Math.abs(x), 1e-9))); // the fraction of the way from the middle to the eye at which the line leaves the whole box
  return { type, center: add(at, scale(towards, Math.min(out, 1))), radius: longest / 3 };
}

// Returns the cut, moved to a point. The point becomes the middle of a box or a sphere, or a
// point of a plane.
function movedTo(cut, point) {
  if (cut.type === "plane") return { ...cut, point };
  if (cut.type === "sphere") return { ...cut, center: point };
  const way = subtract(point, middle(cut));
  return { ...cut, min: add(cut.min, way), max: add(cut.max, way) };
}

// Makes a row of one number field or of three.
function numbers({ label, noun, count, get, set }) {
  const fields = Array.from({ length: count }, (_, k) => {
    const name = count > 1 ? `${label} ${"xyz"[k]}` : label;
    const field = make("input", {
      type: "number", step: "any", "aria-label": `${name} of the ${noun}`,
      onchange: () => {
        const values = [get()].flat().map((value, n) => (n === k ? +field.value : value));
        if (field.value !== "" && Number.isFinite(+field.value)) set(count > 1 ? values : values[0]);
        update();
      },
    });
    return field;
  });
  function update() {
    [get()].flat().forEach((value, k) => { if (!isActive(fields[k])) fields[k].value = shortNumber(value); });
  }
  return { element: row(make("span", { class: "name" }, label), make("span", { class: "numbers" }, ...fields)), update };
}

// Makes a panel of the cuts of one owner, a volume or the scene. kind: the kind of current.js that chooses among the cuts. owner():
// returns the owner's index; -1: there is no owner, and the panel is hidden. cuts(): returns the owner's cuts in the scene. take(name,
// change): changes the cuts. box(): returns the box that is cut. transform(): returns the transform from the box to the scene. others():
// returns further rows. While the panel is open, the chosen cut has handles in the picture.
function panelOf({ title, noun, kind, viewer: { store, current, overlay, report, slices }, owner, cuts, take: takeCuts, box, transform, others }) {
  const { element, body } = section(title, false), rows = make("div");
  let parts = [], told = ""; // tells for which cut the rows were made

  // Cuts that are switched off are kept as [{ cut, at }], where `at` is the cut's index in the list
  // of all cuts.
  const key = () => `${kind} ${owner()}`;
  const off = () => [store.aside(key()) ?? []].flat().filter((one) => isComplete(one?.cut) && Number.isInteger(one.at));
  // Returns all cuts, switched on or off, as [{ cut, on }].
  const list = () => off().reduce((all, { cut, at }) => all.toSpliced(at, 0, { cut, on: false }), cuts().map((cut) => ({ cut, on: true })));
  const chosen = () => current.of(kind, list().length), entry = () => list()[chosen()];

  function take(name, changed) {
    const shown = changed.filter(({ on }) => on).map(({ cut }) => cut), hidden = changed.flatMap(({ cut, on }, at) => (on ? [] : [{ cut, at }]));
    takeCuts(`cuts ${name}`, ({ cuts: _, ...rest }) => (shown.length > 0 ? { ...rest, cuts: shown } : rest));
    if (hidden.length > 0 || off().length > 0) store.putAside(key(), hidden);
  }
  const changeEntry = (name, change) => take(`${chosen()} ${name}`, list().map((one, n) => (n === chosen() ? change(one) : one)));
  const changeCut = (name, part) => changeEntry(name, (one) => ({ ...one, cut: { ...one.cut, ...part } }));

  const fresh = (type) => newCut(type, box(), unplaced(store.scene.camera.position, transform()));

  function setNumbers(name, value) {
    const cut = { ...entry().cut, [name]: value };
    if (cut.type === "plane" && Math.hypot(...cut.normal) === 0) report("A plane needs a direction.");
    else if (cut.type === "box" && cut.min.some((low, k) => low >= cut.max[k])) report("A box's greatest corner has to be beyond its least.");
    else if (cut.type === "sphere" && !(cut.radius > 0)) report("A sphere's radius has to be above 0.");
    else changeCut(name, { [name]: value });
  }

  const numbered = tabs({
    label: title, noun, count: () => list().length, chosen, choose: (n) => current.choose(kind, n),
    add: () => {
      const all = list();
      take("add", [...all, { cut: fresh("plane"), on: true }]);
      current.choose(kind, all.length);
    },
    remove: () => take("remove", list().toSpliced(chosen(), 1)),
  });
  const none = make("p", { class: "facts" }, "+ adds a plane, a box or a sphere, which takes matter away on one side of it.");
  body.append(numbered.element, none, rows);

  function cutParts() {
    const { cut } = entry();
    const shape = segments({
      label: "Shape", choices: [["plane", "Plane"], ["box", "Box"], ["sphere", "Sphere"]], get: () => entry().cut.type,
      set: (type) => changeEntry("type", (one) => ({ ...one, cut: fresh(type) })),
    });
    const places = PARTS[cut.type].map(([name, label]) => numbers({
      label, noun, count: name === "radius" ? 1 : 3, get: () => entry().cut[name], set: (value) => setNumbers(name, value),
    }));
    const toCrosshair = {
      element: row("", button("to the crosshair", () => changeEntry("place", (one) => ({ ...one, cut: movedTo(one.cut, unplaced(slices.cursor, transform())) })), { title: "Moves the cut to where the crosshair of the slices is" })),
      update() { this.element.hidden = slices.layout === "picture"; },
    };
    return [
      toggle({ label: "This cut", get: () => entry().on, set: (on) => changeEntry("on", (one) => ({ ...one, on })) }),
      shape, ...places, toCrosshair,
      segments({ label: "Keep", choices: [["outside", "Outside"], ["inside", "Inside"]], get: () => entry().cut.keep ?? "outside", set: (keep) => changeCut("keep", { keep }) }),
    ];
  }

  // The rows are made anew when the chosen cut has another shape, after a choice or after undo.
  function update() {
    element.hidden = owner() < 0;
    if (element.hidden) return;
    const now = `${owner()} ${entry()?.cut.type}`;
    if (now !== told) {
      parts = entry() ? [...cutParts(), ...others()] : [];
      rows.replaceChildren(...parts.map((part) => part.element));
      told = now;
    }
    none.hidden = entry() !== undefined;
    numbered.update();
    parts.forEach((part) => part.update());
  }
  const chosenCut = () => (element.open && owner() >= 0 && entry()?.on ? entry().cut : null);
  overlay.addCut({ noun, box, transform, cut: chosenCut, take: (cut) => changeEntry("place", (one) => ({ ...one, cut })) });
  element.addEventListener("toggle", () => overlay.draw());
  update();
  return { element, update, updateView: update }; // the layout says whether there is a crosshair
}

// The switch for everything that is cut away or hidden: the cuts, clip boxes and scraps of all volumes, and the
// scene's cuts. A note below the picture says what the program has hidden by itself; a click on the note shows it.
export function cutSwitch(viewer) {
  const { store, start, find } = viewer;
  const cutsOf = ({ volumes, cuts }) => ({ volumes: volumes.map(({ cuts: own, clip, scraps }) => ({ cuts: own, clip, scraps })), cuts });
  const isCut = ({ volumes, cuts }) => cuts?.length > 0 || volumes.some((volume) => volume.cuts?.length > 0 || volume.clip || volume.scraps);
  const withCuts = ({ cuts: _, ...scene }, { volumes = [], cuts }) => ({
    ...scene, ...(cuts ? { cuts } : {}),
    volumes: scene.volumes.map(({ cuts: __, clip: ___, scraps: ____, ...volume }, n) => ({
      ...volume, ...Object.fromEntries(["cuts", "clip", "scraps"].filter((key) => volumes[n]?.[key]).map((key) => [key, volumes[n][key]])),
    })),
  });
  const volumes = start.scene.volumes ?? []; // a scene may consist of meshes only
  const chosen = start.volumes.reduce((count, about, n) => count + (about?.chosen_cuts ? volumes[n].cuts.length : 0), 0);
  const away = () => store.aside("all cuts");
  function set(on) {
    if (!on) store.putAside("all cuts", cutsOf(store.scene));
    if (!on || away()) store.change("all cuts", (scene) => withCuts(scene, on ? away() : { volumes: [] }));
  }
  const all = toggle({ label: "All cuts", get: () => isCut(store.scene), set });
  const hidden = volumes.some((volume) => volume.scraps), leftOut = chosen > 0 || hidden;
  const holders = `${chosen} ${chosen === 1 ? "plane" : "planes"}`;
  const why = [...(chosen > 0 ? [`${holders} ${chosen === 1 ? "takes" : "take"} away what holds the object`] : []), ...(hidden ? ["small bodies beside the object are hidden"] : [])].join(", and ");
  const told = make("p", { class: "facts", hidden: !leftOut }, `${why}: chosen by the program, as nobody said what to cut.`);
  const shows = chosen > 0 ? `show what holds it: ${holders} ${chosen === 1 ? "cuts" : "cut"} it away` : "show hidden small bodies"; // the title tells all
  const note = make("button", { type: "button", class: "note", title: why, hidden: !leftOut, onclick: () => set(!isCut(store.scene)) });
  find("statistics").before(note);
  viewer.toggleCuts = () => set(!isCut(store.scene));
  const element = make("div", { class: "chooser" }, all.element, told);
  function update() {
    all.update();
    element.hidden = !isCut(store.scene) && !away();
    note.textContent = isCut(store.scene) ? shows : chosen > 0 ? "cut away again what holds it" : "hide small bodies again";
  }
  update();
  return { element, update };
}

export function cutPanel(viewer) {
  const { store, start, current } = viewer;
  const volume = () => store.scene.volumes[current.volume];
  const others = () => [
    select({
      label: "Cut faces", choices: [["face", "lit as flat cuts"], ["gradient", "lit by the data"], ["none", "not lit as faces"]],
      get: () => volume().cut_shading ?? "face", set: (value) => store.changeVolume(current.volume, "cut_shading", (v) => ({ ...v, cut_shading: value })),
    }),
    toggle({
      label: "Cut matter casts shadows", get: () => volume().cut_casts_shadow === true,
      set: (on) => store.changeVolume(current.volume, "cut_casts_shadow", (v) => ({ ...v, cut_casts_shadow: on })),
    }),
  ];
  return panelOf({
    title: "Cuts", noun: "cut", kind: "cut", viewer, others, transform: () => volume().transform, owner: () => (volume() === undefined ? -1 : current.volume), cuts: () => volume().cuts ?? [],
    take: (name, change) => store.changeVolume(current.volume, name, change), box: () => worldBox(start.volumes[current.volume]),
  });
}

// The scene's own cuts, where it has several volumes or such cuts already.
export function sceneCutPanel(viewer) {
  const { store, start } = viewer;
  function box() {
    const places = start.volumes.flatMap((about, n) => corners(worldBox(about)).map((corner) => placed(corner, store.scene.volumes[n]?.transform)));
    return { min: [0, 1, 2].map((k) => Math.min(...places.map((at) => at[k]))), max: [0, 1, 2].map((k) => Math.max(...places.map((at) => at[k]))) };
  }
  const volumes = () => store.scene.volumes.length;
  return panelOf({
    title: "Cuts of the scene", noun: "cut of the scene", kind: "sceneCut", viewer, transform: () => ({}), others: () => [], box, cuts: () => store.scene.cuts ?? [],
    owner: () => (volumes() > 1 || (volumes() > 0 && store.scene.cuts?.length > 0) ? 0 : -1), take: (name, change) => store.change(`scene ${name}`, change),
  });
}
